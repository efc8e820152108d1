#include "hud/display.hpp"
#include "hud/draw.hpp"

namespace neritic::hud {

// The corner's numbers are those of the display and a few more, none of which changes while these
// stay.
Shown shown_on_display(Units units, const DiveData& data, double seen_s) {
  return shown_of(LayoutKind::kCorner, units, data, step_alarms({}, data, seen_s), {}, {}, seen_s);
}

void draw_display(Painter& p, const Shown& s) {
  const UnitNames unit = unit_names(s.units);
  constexpr draw2d::Color kScreen{0.005f, 0.012f, 0.018f};
  p.fill({0.0, 0.0, kDisplayWidth_px, kDisplayHeight_px}, kScreen);
  p.cell({{4.0, 2.0, 134.0, 86.0},
          FixedText::of("DEPTH {}", unit.depth).view(),
          s.depth.view(),
          "",
          50.0,
          13.0,
          tone_of(s, Alarm::kCeiling)});
  draw_limit(p, {138.0, 2.0, 98.0, 86.0}, s, s.in_stops ? 34.0 : 44.0, 13.0);
  p.line(6.0, 92.0, 234.0, 92.0, 1.5, kFaint);
  p.cell({{4.0, 95.0, 122.0, 54.0}, "TIME", s.dive_time.view(), "", 26.0, 12.0});
  draw_ceiling_or_deepest(p, {128.0, 95.0, 108.0, 54.0}, s, 26.0, 12.0);
  p.line(6.0, 152.0, 234.0, 152.0, 1.5, kFaint);
  if (any_alarm(s)) {
    p.alarm_band({4.0, 155.0, 232.0, 42.0}, s, 14.0);
    return;
  }
  p.cell({{4.0, 153.0, 122.0, 44.0}, "TANK", s.tank.view(), unit.pressure, 18.0, 11.0});
  p.cell({{128.0, 153.0, 108.0, 44.0}, "TO SURFACE", s.to_surface.view(), "min", 18.0, 11.0});
}

}  // namespace neritic::hud
