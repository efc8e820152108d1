#include "hud/painter.hpp"

#include <algorithm>
#include <cmath>

namespace neritic::hud {
namespace {

using draw2d::Align;
using draw2d::Color;
using draw2d::Face;

std::string_view wind_of(int degrees) {
  constexpr std::string_view kWinds[] = {"N", "NE", "E", "SE", "S", "SW", "W", "NW"};
  return kWinds[(degrees % 360 + 360) % 360 / 45];
}

// Where a text is broken into two lines: at the space nearest to its middle, else between two
// characters there; its end where it is too short.
std::size_t middle_of(std::string_view utf8) {
  const std::size_t middle = utf8.size() / 2;
  for (std::size_t off = 0; off <= middle; ++off)
    for (const std::size_t at : {middle - off, middle + off})
      if (at > 0 && at + 1 < utf8.size() && utf8[at] == ' ') return at;
  std::size_t at = middle;
  while (at < utf8.size() && (static_cast<unsigned char>(utf8[at]) & 0xC0) == 0x80) ++at;
  return at > 0 ? at : utf8.size();
}

}  // namespace

bool any_alarm(const Shown& shown) {
  return std::ranges::any_of(shown.alarms, [](AlarmLevel l) { return l != AlarmLevel::kOff; });
}

bool any_band(const Shown& shown) {
  return any_alarm(shown) || !shown.message.empty();
}

Tone tone_of(const Shown& shown, Alarm alarm) {
  return {shown.alarms[static_cast<std::size_t>(alarm)], shown.flash};
}

Color plate_of(const Tone& tone) {
  if (tone.level == AlarmLevel::kCaution) return kCautionColor;
  return tone.flash ? kInk : kDangerColor;
}

Color ink_of(const Tone& tone) {
  return tone.level == AlarmLevel::kOff ? kInk : kBlack;
}

void Painter::plate(const Box& box, double radius, const Color& color) {
  constexpr int kSteps = 8;  // a corner
  std::vector<Vec2> corners;
  const double r = std::min({radius, 0.5 * box.w, 0.5 * box.h});
  const Vec2 centres[] = {{box.right() - r, box.y + r},
                          {box.right() - r, box.bottom() - r},
                          {box.x + r, box.bottom() - r},
                          {box.x + r, box.y + r}};
  for (int corner = 0; corner < 4; ++corner)
    for (int i = 0; i <= kSteps; ++i) {
      const double turn = 0.5 * kPi * (corner + double(i) / kSteps);
      corners.push_back(scale_ * (centres[corner] + r * Vec2(std::sin(turn), -std::cos(turn))));
    }
  canvas_.fill_polygon(corners, color);
}

void Painter::line(double x0, double y0, double x1, double y1, double width, const Color& color) {
  canvas_.segment(scale_ * x0, scale_ * y0, scale_ * x1, scale_ * y1, scale_ * width, color);
}

void Painter::fill(const Box& box, const Color& color) {
  canvas_.fill_rectangle(scale_ * box.x, scale_ * box.y, scale_ * box.right(),
                         scale_ * box.bottom(), color);
}

void Painter::outline(const Box& box, double width, const Color& color) {
  fill({box.x, box.y, box.w, width}, color);
  fill({box.x, box.bottom() - width, box.w, width}, color);
  fill({box.x, box.y + width, width, box.h - 2.0 * width}, color);
  fill({box.right() - width, box.y + width, width, box.h - 2.0 * width}, color);
}

void Painter::triangle(double x, double y, double half, bool up, const Color& color) {
  const double tip = up ? -half : half;
  const Vec2 corners[] = {scale_ * Vec2(x, y + tip), scale_ * Vec2(x + half, y - tip),
                          scale_ * Vec2(x - half, y - tip)};
  canvas_.fill_polygon(corners, color);
}

void Painter::disc(double x, double y, double radius, const Color& color) {
  canvas_.disc(scale_ * x, scale_ * y, scale_ * radius, color);
}

void Painter::ring(double x, double y, double radius, double width, const Color& color) {
  canvas_.arc(scale_ * x, scale_ * y, scale_ * radius, 0.0, 2.0 * kPi, scale_ * width, color);
}

void Painter::polyline(std::span<const Vec2> points, double width, const Color& color) {
  std::vector<Vec2> scaled(points.begin(), points.end());
  for (Vec2& p : scaled) p *= scale_;
  canvas_.polyline(scaled, scale_ * width, color);
}

double Painter::width(double size, std::string_view utf8, Face face) {
  return canvas_.text_width(scale_ * size, utf8, face) / scale_;
}

double Painter::text(double x, double y, double size, std::string_view utf8, const Color& color,
                     Align align, Face face) {
  const double w = width(size, utf8, face);
  const double left = align == Align::kRight ? x - w : align == Align::kCenter ? x - 0.5 * w : x;
  marks_.push_back({{left, y - size, w, size}, size, utf8});
  canvas_.text(scale_ * left, scale_ * y, scale_ * size, utf8, color, Align::kLeft, face);
  return w;
}

void Painter::cell(const Cell& c) {
  constexpr double kPad = 6.0, kUnitGap = 4.0;
  const bool alarmed = c.tone.level != AlarmLevel::kOff;
  const Color ink = ink_of(c.tone);
  if (alarmed) plate(c.box, 6.0, plate_of(c.tone));
  const double label_room = c.box.w - 2.0 * kPad,
               label_w = width(c.label_size, c.label, Face::kRegular);
  text(c.box.x + kPad, c.box.y + kPad + c.label_size,
       label_w > label_room ? c.label_size * label_room / label_w : c.label_size, c.label,
       alarmed ? kBlack : kLabel);
  const double unit_size = std::max(c.label_size, 0.34 * c.size);
  const double unit_w = c.unit.empty() ? 0.0 : kUnitGap + width(unit_size, c.unit, Face::kRegular);
  const double room = c.box.w - 2.0 * kPad - unit_w;
  const double wanted = width(c.size, c.value, Face::kBold);
  const double size = wanted > room ? c.size * room / wanted : c.size;
  const double base = c.box.bottom() - kPad;
  const double w = text(c.box.x + kPad, base, size, c.value, ink, Align::kLeft, Face::kBold);
  if (!c.unit.empty())
    text(c.box.x + kPad + w + kUnitGap, base, unit_size, c.unit, alarmed ? kBlack : kLabel);
}

void Painter::key(const Box& box, std::string_view word, bool pressed, double size) {
  if (pressed)
    plate(box, 5.0, kInk);
  else
    outline(box, 1.5, kFaint);
  const Face face = pressed ? Face::kBold : Face::kRegular;
  const double room = box.w - 6.0, wide = width(size, word, face);
  const double fitted = wide > room ? size * room / wide : size;
  text(box.x + 0.5 * box.w, box.y + 0.5 * (box.h + fitted), fitted, word, pressed ? kBlack : kLabel,
       Align::kCenter, face);
}

void Painter::level(const Box& box, std::uint8_t step) {
  outline(box, 1.5, kFaint);
  if (step == kNoStep || step == 0) return;
  fill({box.x + 3.0, box.y + 3.0, (box.w - 6.0) * step / kBarSteps, box.h - 6.0}, kLabel);
}

void Painter::ascent_bar(const Box& box, const Shown& shown, double size, double unit_size) {
  const double number = box.bottom() - unit_size - 4.0, below = box.bottom() - number + size + 5.0;
  const double gap_of_steps = std::min(3.0, 0.3 * (box.h - below) / kAscentSteps);
  const Tone tone = tone_of(shown, Alarm::kAscent);
  const bool alarmed = tone.level != AlarmLevel::kOff;
  if (alarmed) plate({box.x - 7.0, box.y - 6.0, box.w + 14.0, box.h + 12.0}, 6.0, plate_of(tone));
  const Color lit = alarmed ? kBlack : kInk;
  const Color dim = alarmed ? Color{0.0f, 0.0f, 0.0f, 0.25f} : kFaint;
  const double step = (box.h - below + gap_of_steps) / kAscentSteps;
  for (int i = 0; i < kAscentSteps; ++i) {
    const double y = box.bottom() - below - (i + 1) * step + gap_of_steps;
    // Beyond the limits the steps narrow to an arrowhead: a shape, not a colour alone.
    const double narrow = i < shown.fast_steps ? 0.0 : 0.12 * box.w * (i - shown.fast_steps + 1);
    const Box part{box.x + narrow, y, box.w - 2.0 * narrow, step - gap_of_steps};
    if (i < shown.ascent_steps)
      fill(part, i < shown.fast_steps || alarmed ? lit : kCautionColor);
    else
      outline(part, 1.5, dim);
  }
  // An arrow and the number, together in the middle.
  const double mark = 0.34 * size, gap = 3.0;
  const double w = width(size, shown.ascent.view(), Face::kBold);
  const double arrow = shown.rises == 0 ? 0.0 : 2.0 * mark + gap;
  const double left = box.x + 0.5 * (box.w - w - arrow);
  text(left + arrow, number, size, shown.ascent.view(), lit, Align::kLeft, Face::kBold);
  if (shown.rises != 0) triangle(left + mark, number - 0.5 * size, mark, shown.rises > 0, lit);
  const char* const unit = unit_names(shown.units).rate;
  const double room = box.w + 12.0, wide = width(unit_size, unit, Face::kRegular);
  text(box.x + 0.5 * box.w, box.bottom(), wide > room ? unit_size * room / wide : unit_size, unit,
       alarmed ? kBlack : kLabel, Align::kCenter);
}

void Painter::tissues(const Box& box, const Shown& shown) {
  constexpr double kGap = 2.0;
  const double step = (box.w + kGap) / static_cast<double>(shown.tissues.size());
  for (std::size_t i = 0; i < shown.tissues.size(); ++i) {
    const double x = box.x + step * static_cast<double>(i);
    fill({x, box.y, step - kGap, box.h}, kFaint.with_alpha(0.14f));
    if (shown.tissues[i] == kNoStep) continue;
    const double h = box.h * shown.tissues[i] / kBarSteps;
    fill({x, box.bottom() - h, step - kGap, h},
         2 * shown.tissues[i] > kBarSteps ? kCautionColor : kLabel);
  }
  // Ambient pressure: what is above it leaves the tissues.
  line(box.x, box.y + 0.5 * box.h, box.right(), box.y + 0.5 * box.h, 1.5, kInk);
  line(box.x, box.y, box.right(), box.y, 1.5, kInk);
}

void Painter::compass(const Box& box, const Shown& shown, double size) {
  constexpr double kHalfSpan_deg = 60.0;
  const double middle = box.x + 0.5 * box.w, base = box.bottom() - 2.0;
  const double half = 0.5 * box.w;
  text(middle, box.y + size * 1.25, size * 1.25,
       FixedText::of("{}\u00b0", shown.heading.view()).view(), kInk, Align::kCenter, Face::kBold);
  if (shown.heading_deg < 0) return;
  const double number = 0.5 * width(size * 1.25, "000\u00b0", Face::kBold) + 6.0;
  for (int off = -static_cast<int>(kHalfSpan_deg); off <= kHalfSpan_deg; ++off) {
    const int bearing = shown.heading_deg + off;
    if (bearing % 15 != 0) continue;
    const double x = middle + half * off / kHalfSpan_deg;
    const bool named = bearing % 45 == 0;
    line(x, base - (named ? 9.0 : 6.0), x, base, 2.0, named ? kInk : kLabel);
    const std::string_view wind = wind_of(bearing);
    const double reach = 0.5 * width(size, wind, Face::kRegular);
    if (named && std::abs(x - middle) > number + reach && std::abs(x - middle) + reach <= half)
      text(x, box.y + size * 1.25, size, wind, kLabel, Align::kCenter);
  }
  triangle(middle, base - 4.0, 5.0, true, kCautionColor);
}

void Painter::alarm_band(const Box& box, const Shown& shown, double size) {
  const Advice& advice = shown.advice;
  if (advice.level == AlarmLevel::kOff) return;
  const Tone tone{advice.level, shown.flash};
  plate(box, 8.0, plate_of(tone));
  const double mark = 0.32 * box.h, x = box.x + 12.0 + mark;
  triangle(x, box.y + 0.5 * box.h, mark, true, kBlack);
  const double bang = 0.36 * box.h;
  canvas_.text(scale_ * x, scale_ * (box.y + 0.5 * box.h + mark - 0.10 * box.h), scale_ * bang, "!",
               plate_of(tone), Align::kCenter, Face::kBold);
  const double left = x + mark + 12.0;
  double right = box.right() - 10.0;
  if (advice.others > 0) {
    const FixedText more = FixedText::of("+{}", advice.others);
    right -= text(right, box.y + 0.5 * (box.h + size), size, more.view(), kBlack, Align::kRight,
                  Face::kBold) +
             8.0;
  }
  const auto fitted = [&](std::string_view words, double wanted) {
    return std::min(wanted, wanted * (right - left) / width(wanted, words, Face::kBold));
  };
  const double space = (box.h - 1.75 * size) / 3.0;
  const std::string_view what = advice.what.view(), act = advice.act.view();
  text(left, box.y + space + size, fitted(what, size), what, kBlack, Align::kLeft, Face::kBold);
  text(left, box.bottom() - space, fitted(act, 0.75 * size), act, kBlack, Align::kLeft,
       Face::kBold);
}

void Painter::message_band(const Box& box, const Shown& shown, double size) {
  const std::string_view words = shown.message.view();
  if (words.empty()) return;
  plate(box, 8.0, kLabel);
  const double left = box.x + 12.0, room = box.w - 24.0, label = 0.62 * size, least = label;
  const auto fitted = [&](std::string_view line, double wanted, Face face) {
    return std::min(wanted, wanted * room / width(wanted, line, face));
  };
  // A long line is drawn thinner before it is cut.
  const auto line_at = [&](double y, std::string_view line, double wanted, Face face) {
    if (fitted(line, wanted, face) < least) face = Face::kRegular;
    const double fits = std::max(fitted(line, wanted, face), least);
    text(left, y, fits, canvas_.shortened(scale_ * fits, line, scale_ * room, face), kBlack,
         Align::kLeft, face);
  };
  // Two lines where one would be as small.
  const double two = 0.78 * size;
  const std::size_t cut = fitted(words, size, Face::kBold) < two ? middle_of(words) : words.size();
  const bool broken = cut < words.size();
  const double high = broken ? two : size;
  const double space = (box.h - label - (broken ? 2.0 : 1.0) * high) / (broken ? 4.0 : 3.0);
  double y = box.y + space + label;
  line_at(y, shown.message_from.view(), label, Face::kRegular);
  line_at(y += space + high, words.substr(0, cut), high, Face::kBold);
  if (!broken) return;
  const std::string_view rest = words.substr(cut);
  line_at(y + space + high, rest.front() == ' ' ? rest.substr(1) : rest, high, Face::kBold);
}

}  // namespace neritic::hud
