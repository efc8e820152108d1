// The operator's console: the diver on the left, streams and sonar on the right, heart and breath
// below, and the view itself in the middle with the place that the diver looks at.
#include "hud/draw.hpp"

namespace neritic::hud {
namespace {

using draw2d::Align;
using draw2d::Color;
using draw2d::Face;

constexpr double kTitle = 12.0, kLeft = 16.0, kWide = 300.0, kStreamRow = 26.0;
constexpr Box kDiver{kLeft, 16.0, kWide, 688.0}, kCompass{490.0, 16.0, 300.0, 56.0};
constexpr Box kAlarmBand{400.0, 80.0, 480.0, 60.0}, kMessageBand{400.0, 148.0, 480.0, 60.0},
    kCondition{332.0, 462.0, 616.0, 90.0};
constexpr Box kHeart{332.0, 560.0, 304.0, 144.0}, kBreath{644.0, 560.0, 304.0, 144.0};
// The camera alone has the sonar's place.
constexpr Box kSonar{964.0, 404.0, kWide, 300.0}, kCamera{964.0, 216.0, kWide, 180.0};

const Box& camera_plate(const Shown& s) {
  return s.sonar.empty() ? kSonar : kCamera;
}

Box picture_place(const Box& plate) {
  return {plate.x + 8.0, plate.y + 32.0, plate.w - 16.0, plate.h - 40.0};
}

Box streams_plate(const Shown& s) {
  const double rows =
      std::max<double>(1.0, static_cast<double>(s.stream_count)) + (s.more_streams > 0 ? 1.0 : 0.0);
  return {964.0, 16.0, kWide, 40.0 + kStreamRow * rows};
}

void title(Painter& p, double x, double y, std::string_view words) {
  p.text(x, y, kTitle, words, kLabel, Align::kLeft, Face::kBold);
}

// Until there is a picture its place says so.
void draw_picture_plate(Painter& p, const Box& plate, std::string_view name) {
  p.plate(plate, 14.0, kPlate);
  const double room = plate.w - 24.0, wide = p.width(kTitle, name, Face::kBold);
  p.text(plate.x + 12.0, plate.y + 22.0, kTitle * std::min(1.0, room / wide), name, kLabel,
         Align::kLeft, Face::kBold);
  const Box place = picture_place(plate);
  p.text(place.x + 0.5 * place.w, place.y + 0.5 * place.h, 11.0, "waits for its picture", kLabel,
         Align::kCenter);
}

void draw_jacket(Painter& p, const Box& box, const Shown& s) {
  const UnitNames unit = unit_names(s.units);
  title(p, box.x + 6.0, box.y + 18.0, "JACKET");
  // The bladder, filled from its top: gas lies there.
  const Box bladder{box.x + 8.0, box.y + 30.0, 44.0, box.h - 40.0};
  p.plate(bladder, 12.0, kFaint.with_alpha(0.14f));
  if (s.jacket_step != kNoStep && s.jacket_step > 0)
    p.fill({bladder.x + 4.0, bladder.y + 6.0, bladder.w - 8.0,
            (bladder.h - 12.0) * s.jacket_step / kBarSteps},
           kLabel);
  p.cell(
      {{box.x + 60.0, box.y + 24.0, 112.0, 52.0}, "GAS", s.jacket.view(), unit.volume, 20.0, 12.0});
  p.cell(
      {{box.x + 176.0, box.y + 24.0, 118.0, 52.0}, "LIFT", s.lift.view(), unit.weight, 20.0, 12.0});
  const char* net = !s.net_known ? "NET" : s.sinks ? "SINKS" : "FLOATS";
  p.cell({{box.x + 60.0, box.y + 78.0, 112.0, 52.0}, net, s.net.view(), unit.weight, 20.0, 12.0});
  double y = box.y + 82.0;
  for (const JacketKey& key : kJacketKeys) {
    p.key({box.x + 182.0, y, 104.0, 20.0}, key.word, (s.buttons & key.bit) != 0, 11.0);
    y += 24.0;
  }
}

void draw_diver(Painter& p, const Shown& s) {
  const UnitNames unit = unit_names(s.units);
  const double x = kLeft, right = x + 152.0;
  p.plate(kDiver, 14.0, kPlate);
  p.cell({{x + 6.0, 22.0, 214.0, 104.0},
          FixedText::of("DEPTH {}", unit.depth).view(),
          s.depth.view(),
          "",
          54.0,
          12.0,
          tone_of(s, Alarm::kCeiling)});
  p.ascent_bar({x + 238.0, 30.0, 38.0, 96.0}, s, 15.0, 11.0);
  draw_limit(p, {x + 6.0, 136.0, 176.0, 80.0}, s, s.in_stops ? 34.0 : 40.0, 12.0);
  p.cell({{x + 186.0, 136.0, 108.0, 80.0}, "TO SURFACE", s.to_surface.view(), "min", 28.0, 12.0});
  p.cell({{x + 6.0, 222.0, 142.0, 62.0}, "TIME", s.dive_time.view(), "", 24.0, 12.0});
  draw_ceiling_or_deepest(p, {right, 222.0, 142.0, 62.0}, s, 24.0, 12.0);
  p.cell({{x + 6.0, 288.0, 142.0, 62.0},
          "TANK",
          s.tank.view(),
          unit.pressure,
          24.0,
          12.0,
          tone_of(s, Alarm::kGas)});
  p.cell({{right, 288.0, 142.0, 62.0}, "LASTS", s.gas_min.view(), "min", 24.0, 12.0});
  p.cell({{x + 6.0, 354.0, 128.0, 54.0},
          FixedText::of("MOD {} {}", s.mod.view(), unit.depth).view(),
          s.gas.view(),
          "",
          19.0,
          12.0});
  p.cell({{x + 136.0, 354.0, 86.0, 54.0},
          "pO2 bar",
          s.oxygen.view(),
          "",
          19.0,
          12.0,
          tone_of(s, Alarm::kOxygen)});
  p.cell({{x + 224.0, 354.0, 72.0, 54.0}, "CNS", s.cns.view(), "%", 19.0, 12.0, {s.cns_level}});
  title(p, x + 12.0, 436.0, "TISSUES");
  p.text(x + kWide - 12.0, 436.0, 11.0, "line: ambient, top: limit", kLabel, Align::kRight);
  p.tissues({x + 12.0, 446.0, kWide - 24.0, 78.0}, s);
  draw_jacket(p, {x + 4.0, 536.0, kWide - 8.0, 164.0}, s);
}

void draw_health(Painter& p, double x, double y, Health health) {
  if (health == Health::kGood) {
    p.disc(x, y, 5.0, kInk);
  } else if (health == Health::kWaiting) {
    p.ring(x, y, 4.5, 2.0, kCautionColor);
  } else {
    p.line(x - 4.0, y - 4.0, x + 4.0, y + 4.0, 2.5, kDangerText);
    p.line(x - 4.0, y + 4.0, x + 4.0, y - 4.0, 2.5, kDangerText);
  }
}

void draw_streams(Painter& p, const Shown& s) {
  const Box plate = streams_plate(s);
  const double x = plate.x, row = kStreamRow;
  p.plate(plate, 14.0, kPlate);
  title(p, x + 12.0, 38.0, "STREAMS");
  double y = 62.0;
  if (s.stream_count == 0) p.text(x + 12.0, y, 11.0, "none from outside", kLabel);
  for (std::size_t i = 0; i < s.stream_count; ++i, y += row) {
    const StreamHealth& stream = s.streams[i];
    draw_health(p, x + 18.0, y - 5.0, stream.health);
    const double w = p.text(x + 32.0, y, 11.0, stream.name.view(), kInk);
    const double room = kWide - 32.0 - w - 24.0;
    const double wide = p.width(11.0, stream.note.view(), Face::kRegular);
    const Color color = stream.health == Health::kGood      ? kLabel
                        : stream.health == Health::kWaiting ? kCautionColor
                                                            : kDangerText;
    p.text(x + kWide - 12.0, y, 11.0 * std::min(1.0, room / wide), stream.note.view(), color,
           Align::kRight);
  }
  if (s.more_streams > 0)
    p.text(x + 12.0, y, 11.0, FixedText::of("and {} more", s.more_streams).view(), kLabel);
}

// ends: texts of the trace's, with their unit.
void draw_trace(Painter& p, const Box& box, const char* name, std::string_view value,
                const char* unit, const FixedText (&ends)[2],
                const std::array<std::uint8_t, Minute::kSamples>& trace) {
  p.plate(box, 14.0, kPlate);
  title(p, box.x + 14.0, box.y + 24.0, name);
  const double right = box.right() - 14.0;
  const double w = p.text(right, box.y + 34.0, 11.0, unit, kLabel, Align::kRight);
  p.text(right - w - 6.0, box.y + 34.0, 24.0, value, kInk, Align::kRight, Face::kBold);
  const Box plot{box.x + 82.0, box.y + 46.0, box.w - 96.0, box.h - 76.0};
  p.text(plot.x - 6.0, plot.y + 11.0, 11.0, ends[1].view(), kLabel, Align::kRight);
  p.text(plot.x - 6.0, plot.bottom(), 11.0, ends[0].view(), kLabel, Align::kRight);
  p.line(plot.x, plot.bottom(), plot.right(), plot.bottom(), 1.0, kFaint);
  p.line(plot.x, plot.y, plot.right(), plot.y, 1.0, kFaint);
  p.text(plot.x, box.bottom() - 10.0, 11.0, "60 s ago", kLabel);
  p.text(plot.right(), box.bottom() - 10.0, 11.0, "now", kLabel, Align::kRight);
  std::vector<Vec2> points;
  const auto flush = [&] {
    if (points.size() > 1) p.polyline(points, 2.0, kInk);
    points.clear();
  };
  for (std::size_t i = 0; i < trace.size(); ++i) {
    if (trace[i] == 0) {
      flush();
      continue;
    }
    points.emplace_back(plot.x + plot.w * static_cast<double>(i) / (trace.size() - 1.0),
                        plot.bottom() - plot.h * (trace[i] - 1) / 254.0);
  }
  flush();
}

// Over heart and breath, as wide as both; nothing where the scene does not model it.
void draw_condition(Painter& p, const Shown& s) {
  const ShownCondition& c = s.condition;
  if (!c.known) return;
  constexpr double kX = kCondition.x, kY = kCondition.y, kW = kCondition.w;
  p.plate(kCondition, 14.0, kPlate);
  title(p, kX + 14.0, kY + 24.0, "CONDITION");
  if (c.unconscious) {
    const Tone danger{AlarmLevel::kDanger, s.flash};
    p.plate({kX + 330.0, kY + 8.0, kW - 342.0, 24.0}, 6.0, plate_of(danger));
    p.text(kX + 330.0 + 0.5 * (kW - 342.0), kY + 26.0, 13.0, "UNCONSCIOUS: RESCUE", ink_of(danger),
           Align::kCenter, Face::kBold);
  } else {
    p.text(kX + kW - 14.0, kY + 24.0, 11.0, "modelled; not noticed by the diver", kLabel,
           Align::kRight);
  }
  const UnitNames unit = unit_names(s.units);
  const char* degree = s.units == Units::kImperial ? "F" : "C";
  struct Part {
    double wide;
    const char* label;
    std::string_view value;
    const char* unit;
  };
  const Part parts[] = {{74.0, "O2 SAT", c.saturation.view(), "%"},
                        {106.0, "CO2 mmHg", c.co2.view(), ""},
                        {96.0, "NARCOTIC", c.narcotic.view(), unit.depth},
                        {80.0, "O2 DOSE", c.oxygen.view(), "%"},
                        {74.0, "CORE", c.core.view(), degree},
                        {76.0, "REACTS", c.slowing.view(), "x"},
                        {96.0, "STRENGTH", c.strength.view(), "%"}};
  double x = kX + 7.0;
  for (std::size_t i = 0; i < std::size(parts); x += parts[i].wide, ++i) {
    const bool alarmed = (c.cautions & (1u << i)) != 0;
    p.cell({{x, kY + 36.0, parts[i].wide - 2.0, 50.0},
            parts[i].label,
            parts[i].value,
            parts[i].unit,
            18.0,
            12.0,
            {alarmed ? AlarmLevel::kCaution : AlarmLevel::kOff, false}});
  }
}

// A ring with four ticks; the words stand on a plate of their own.
void draw_gaze(Painter& p, const Shown& s) {
  const double x = 1.280 * s.gaze_x, y = 0.720 * s.gaze_y;
  p.ring(x, y, 17.0, 6.0, kBlack.with_alpha(0.75f));
  p.ring(x, y, 17.0, 3.0, kInk);
  for (const Vec2 way : {Vec2(1, 0), Vec2(-1, 0), Vec2(0, 1), Vec2(0, -1)})
    p.line(x + 17.0 * way.x, y + 17.0 * way.y, x + 25.0 * way.x, y + 25.0 * way.y, 3.0, kInk);
  p.plate({x + 22.0, y + 14.0, 54.0, 20.0}, 5.0, kPlate);
  p.text(x + 49.0, y + 29.0, 11.0, "GAZE", kInk, Align::kCenter, Face::kBold);
}

}  // namespace

std::vector<Box> console_plates(const Shown& s) {
  std::vector<Box> out{kDiver, kCompass, kAlarmBand, kHeart, kBreath, streams_plate(s)};
  if (!s.message.empty()) out.push_back(kMessageBand);
  if (s.condition.known) out.push_back(kCondition);
  if (!s.sonar.empty()) out.push_back(kSonar);
  if (!s.camera.empty()) out.push_back(camera_plate(s));
  return out;
}

std::optional<Box> sonar_place(const Shown& s) {
  return s.sonar.empty() ? std::nullopt : std::optional(picture_place(kSonar));
}

std::optional<Box> camera_place(const Shown& s) {
  return s.camera.empty() ? std::nullopt : std::optional(picture_place(camera_plate(s)));
}

void draw_console(Painter& p, const Shown& s) {
  if (s.has_gaze) draw_gaze(p, s);
  draw_diver(p, s);
  draw_streams(p, s);
  if (!s.sonar.empty()) draw_picture_plate(p, kSonar, s.sonar.view());
  if (!s.camera.empty()) draw_picture_plate(p, camera_plate(s), s.camera.view());
  p.plate(kCompass, 14.0, kPlate);
  p.compass({502.0, 22.0, 276.0, 46.0}, s, 14.0);
  if (any_alarm(s)) p.alarm_band(kAlarmBand, s, 20.0);
  p.message_band(kMessageBand, s, 20.0);
  draw_condition(p, s);
  const auto rate = [](double bpm) { return FixedText::of("{:.0f}/min", bpm); };
  const auto volume = [&](double litres) {
    return FixedText::of("{} {}", litres_text(1e-3 * litres, s.units).view(),
                         unit_names(s.units).volume);
  };
  draw_trace(p, kHeart, "HEART", s.heart.view(), "beats/min",
             {rate(kHeartTrace_bpm[0]), rate(kHeartTrace_bpm[1])}, s.heart_trace);
  draw_trace(p, kBreath, "BREATH", s.breath.view(), "breaths/min",
             {volume(kLungsTrace_l[0]), volume(kLungsTrace_l[1])}, s.lungs_trace);
}

}  // namespace neritic::hud
