// The layouts that a diver wears. Depth and time until something is owed are largest; what an alarm
// is about changes its plate too.
#include "hud/draw.hpp"

#include <algorithm>

namespace neritic::hud {
namespace {

using draw2d::Color;

FixedText with_unit(const char* label, const char* unit) {
  return FixedText::of("{} {}", label, unit);
}

// The stop's depth is the number that is owed; above the ceiling it is what the alarm is about.
Tone limit_tone(const Shown& shown) {
  return tone_of(shown, shown.in_stops ? Alarm::kCeiling : Alarm::kNoStop);
}

Tone depth_tone(const Shown& shown) {
  return tone_of(shown, Alarm::kCeiling);
}

// An alarm, which must not be missed, takes the place of a message.
void draw_band(Painter& p, const Box& box, const Shown& shown, double size) {
  if (any_alarm(shown))
    p.alarm_band(box, shown, size);
  else
    p.message_band(box, shown, size);
}

}  // namespace

void draw_limit(Painter& p, const Box& box, const Shown& shown, double size, double label_size) {
  if (!shown.in_stops) {
    p.cell({box, "NO STOP", shown.no_stop.view(), "min", size, label_size, limit_tone(shown)});
    return;
  }
  const double part = 0.58 * box.w;  // metres may have a decimal
  p.cell({{box.x, box.y, part, box.h},
          with_unit("STOP", unit_names(shown.units).depth).view(),
          shown.stop.view(),
          "",
          size,
          label_size,
          limit_tone(shown)});
  p.cell({{box.x + part, box.y, box.w - part, box.h},
          "min",
          shown.stop_min.view(),
          "",
          size,
          label_size});
}

void draw_ceiling_or_deepest(Painter& p, const Box& box, const Shown& s, double size,
                             double label_size) {
  const char* const unit = unit_names(s.units).depth;
  if (s.in_stops)
    p.cell({box, "CEILING", s.ceiling.view(), unit, size, label_size, depth_tone(s)});
  else
    p.cell({box, "DEEPEST", s.deepest.view(), unit, size, label_size});
}

void draw_jacket_cells(Painter& p, const Box& gas, const Box& lift, const Shown& s, double size,
                       double label_size) {
  const UnitNames unit = unit_names(s.units);
  p.cell({gas, "JACKET", s.jacket.view(), unit.volume, size, label_size});
  p.cell({lift, "LIFT", s.lift.view(), unit.weight, size, label_size});
}

void draw_jacket_row(Painter& p, const Box& box, const Shown& s, double size, double label_size) {
  const double cell = 0.19 * box.w, keys = box.x + 2.0 * cell + 6.0, gap = 4.0;
  draw_jacket_cells(p, {box.x, box.y, cell, box.h}, {box.x + cell, box.y, cell, box.h}, s, size,
                    label_size);
  const double w = (box.right() - keys - 2.0 * gap) / 3.0, h = 0.46 * box.h;
  for (std::size_t i = 0; i < std::size(kJacketKeys); ++i)
    p.key({keys + static_cast<double>(i) * (w + gap), box.y + 4.0, w, h}, kJacketKeys[i].word,
          (s.buttons & kJacketKeys[i].bit) != 0, label_size);
  p.level({keys, box.y + h + 10.0, box.right() - keys, box.h - h - 16.0}, s.jacket_step);
}

void draw_wrist(Painter& p, const Shown& s) {
  const UnitNames unit = unit_names(s.units);
  constexpr Color kCase{0.16f, 0.17f, 0.18f}, kScreen{0.005f, 0.012f, 0.018f};
  p.plate({0.0, 0.0, 480.0, 460.0}, 34.0, kCase);
  p.plate({8.0, 8.0, 464.0, 444.0}, 28.0, kScreen);
  p.cell({{18.0, 20.0, 226.0, 122.0},
          with_unit("DEPTH", unit.depth).view(),
          s.depth.view(),
          "",
          66.0,
          14.0,
          depth_tone(s)});
  p.ascent_bar({257.0, 28.0, 41.0, 108.0}, s, 16.0, 12.0);
  draw_limit(p, {310.0, 20.0, 152.0, 122.0}, s, s.in_stops ? 40.0 : 54.0, s.in_stops ? 12.0 : 14.0);
  p.line(20.0, 149.0, 460.0, 149.0, 1.5, kFaint);
  p.cell({{18.0, 154.0, 150.0, 74.0}, "TIME", s.dive_time.view(), "", 30.0, 13.0});
  draw_ceiling_or_deepest(p, {170.0, 154.0, 136.0, 74.0}, s, 30.0, 13.0);
  p.cell({{310.0, 154.0, 152.0, 74.0}, "TO SURFACE", s.to_surface.view(), "min", 30.0, 13.0});
  p.line(20.0, 233.0, 460.0, 233.0, 1.5, kFaint);
  p.cell({{18.0, 238.0, 132.0, 72.0},
          "TANK",
          s.tank.view(),
          unit.pressure,
          30.0,
          13.0,
          tone_of(s, Alarm::kGas)});
  p.cell({{152.0, 238.0, 100.0, 72.0}, "LASTS", s.gas_min.view(), "min", 22.0, 13.0});
  p.cell({{254.0, 238.0, 78.0, 72.0},
          "pO2 bar",
          s.oxygen.view(),
          "",
          22.0,
          13.0,
          tone_of(s, Alarm::kOxygen)});
  p.cell({{334.0, 238.0, 128.0, 72.0},
          FixedText::of("MOD {} {}", s.mod.view(), unit.depth).view(),
          s.gas.view(),
          "",
          22.0,
          12.0});
  p.line(20.0, 315.0, 460.0, 315.0, 1.5, kFaint);
  draw_jacket_row(p, {18.0, 318.0, 442.0, 56.0}, s, 20.0, 12.0);
  p.line(20.0, 379.0, 460.0, 379.0, 1.5, kFaint);
  if (any_band(s)) {
    draw_band(p, {18.0, 384.0, 444.0, 60.0}, s, 20.0);
    return;
  }
  p.tissues({28.0, 392.0, 150.0, 46.0}, s);
  p.cell({{184.0, 380.0, 70.0, 64.0}, "CNS", s.cns.view(), "%", 18.0, 13.0, {s.cns_level}});
  p.compass({262.0, 392.0, 190.0, 46.0}, s, 14.0);
}

void draw_corner(Painter& p, const Shown& s) {
  const UnitNames unit = unit_names(s.units);
  p.plate({0.0, 0.0, 400.0, any_band(s) ? 358.0 : 304.0}, 18.0, kPlate);
  p.cell({{10.0, 8.0, 188.0, 108.0},
          with_unit("DEPTH", unit.depth).view(),
          s.depth.view(),
          "",
          55.0,
          13.0,
          depth_tone(s)});
  p.ascent_bar({207.0, 16.0, 31.0, 96.0}, s, 14.0, 10.0);
  if (s.in_stops) {
    draw_limit(p, {248.0, 8.0, 144.0, 60.0}, s, 28.0, 12.0);
    draw_ceiling_or_deepest(p, {248.0, 71.0, 144.0, 45.0}, s, 17.0, 12.0);
  } else {
    draw_limit(p, {248.0, 8.0, 144.0, 108.0}, s, 46.0, 12.0);
  }
  p.line(14.0, 122.0, 386.0, 122.0, 1.5, kFaint);
  p.cell({{10.0, 126.0, 130.0, 62.0}, "TIME", s.dive_time.view(), "", 25.0, 12.0});
  p.cell({{142.0, 126.0, 122.0, 62.0},
          "TANK",
          s.tank.view(),
          unit.pressure,
          25.0,
          12.0,
          tone_of(s, Alarm::kGas)});
  p.cell({{266.0, 126.0, 126.0, 62.0}, "TO SURFACE", s.to_surface.view(), "min", 25.0, 12.0});
  p.cell({{10.0, 190.0, 130.0, 50.0},
          FixedText::of("MOD {} {}", s.mod.view(), unit.depth).view(),
          s.gas.view(),
          "",
          17.0,
          12.0});
  p.cell({{142.0, 190.0, 122.0, 50.0}, "LASTS", s.gas_min.view(), "min", 17.0, 12.0});
  p.cell({{266.0, 190.0, 62.0, 50.0},
          "pO2 bar",
          s.oxygen.view(),
          "",
          17.0,
          12.0,
          tone_of(s, Alarm::kOxygen)});
  p.cell({{328.0, 190.0, 66.0, 50.0}, "CNS", s.cns.view(), "%", 17.0, 12.0, {s.cns_level}});
  p.line(14.0, 244.0, 386.0, 244.0, 1.5, kFaint);
  draw_jacket_row(p, {10.0, 247.0, 380.0, 50.0}, s, 17.0, 10.0);
  draw_band(p, {8.0, 301.0, 384.0, 50.0}, s, 16.0);
}

namespace {

// Over the mask's row: on the left the ceiling while stops are owed, on the right the jacket with
// the keys that are pressed.
void draw_over_mask(Painter& p, const Shown& s) {
  constexpr Box kCeiling{0.0, 0.0, 150.0, 48.0}, kJacket{718.0, 0.0, 242.0, 48.0};
  if (s.in_stops) {
    p.plate(kCeiling, 12.0, kPlate);
    draw_ceiling_or_deepest(p, {8.0, 2.0, 134.0, 44.0}, s, 17.0, 10.0);
  }
  p.plate(kJacket, 12.0, kPlate);
  draw_jacket_cells(p, {724.0, 2.0, 74.0, 44.0}, {796.0, 2.0, 80.0, 44.0}, s, 16.0, 10.0);
  const auto pressed = [&](const JacketKey& key) { return (s.buttons & key.bit) != 0; };
  const auto count = static_cast<double>(std::ranges::count_if(kJacketKeys, pressed));
  const double gap = 2.0, h = std::min(22.0, (40.0 - gap * (count - 1.0)) / count);
  double y = 24.0 - 0.5 * (count * h + gap * (count - 1.0));
  for (const JacketKey& key : kJacketKeys) {
    if (!pressed(key)) continue;
    p.key({878.0, y, 76.0, h}, key.word, true, std::min(10.0, h - 3.5));
    y += h + gap;
  }
}

}  // namespace

// Along the lower edge of the mask: one row to glance at, the alarm above it.
void draw_mask(Painter& p, const Shown& s) {
  const UnitNames unit = unit_names(s.units);
  const double top = 52.0, h = 88.0;
  draw_over_mask(p, s);
  p.plate({0.0, top, 960.0, h}, 16.0, kPlate);
  p.cell({{12.0, top, 186.0, h},
          with_unit("DEPTH", unit.depth).view(),
          s.depth.view(),
          "",
          46.0,
          12.0,
          depth_tone(s)});
  p.ascent_bar({206.0, top + 8.0, 28.0, h - 16.0}, s, 13.0, 9.0);
  draw_limit(p, {246.0, top, 156.0, h}, s, s.in_stops ? 36.0 : 46.0, 12.0);
  p.cell({{408.0, top, 118.0, h}, "TIME", s.dive_time.view(), "", 28.0, 12.0});
  p.cell({{530.0, top, 116.0, h}, "TO SURFACE", s.to_surface.view(), "min", 28.0, 12.0});
  p.cell({{650.0, top, 144.0, h},
          FixedText::of("{}  {} min", s.gas.view(), s.gas_min.view()).view(),
          s.tank.view(),
          unit.pressure,
          28.0,
          12.0,
          tone_of(s, Alarm::kGas)});
  p.cell({{798.0, top, 80.0, h},
          "pO2 bar",
          s.oxygen.view(),
          "",
          22.0,
          12.0,
          tone_of(s, Alarm::kOxygen)});
  p.cell({{880.0, top, 76.0, h}, "HDG", s.heading.view(), "\u00b0", 22.0, 12.0});
  draw_band(p, {250.0, 0.0, 460.0, 48.0}, s, 17.0);
}

void draw(LayoutKind layout, Painter& painter, const Shown& shown) {
  switch (layout) {
    case LayoutKind::kWrist:
      return draw_wrist(painter, shown);
    case LayoutKind::kMask:
      return draw_mask(painter, shown);
    case LayoutKind::kCorner:
      return draw_corner(painter, shown);
    case LayoutKind::kConsole:
      return draw_console(painter, shown);
  }
}

}  // namespace neritic::hud
