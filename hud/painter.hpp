// The parts that layouts are made of: plates, numbers in cells, bars, the alarms' band. Drawn in a
// layout's own units, times a scale. One owner, one thread.
#pragma once

#include <vector>

#include "engine/draw2d/canvas.hpp"
#include "hud/shown.hpp"

namespace neritic::hud {

struct Box {
  double x = 0, y = 0, w = 0, h = 0;  // left, top, width, height
  double right() const { return x + w; }
  double bottom() const { return y + h; }
};

// Black water and the plate are alike, so a plate keeps its contrast over any water.
inline constexpr draw2d::Color kInk{0.97f, 0.99f, 1.0f}, kLabel{0.60f, 0.87f, 0.96f};
inline constexpr draw2d::Color kFaint{0.60f, 0.87f, 0.96f, 0.30f};
inline constexpr draw2d::Color kPlate{0.01f, 0.025f, 0.035f, 0.90f}, kBlack{0.0f, 0.0f, 0.0f};
inline constexpr draw2d::Color kCautionColor{1.0f, 0.83f, 0.15f}, kDangerColor{1.0f, 0.42f, 0.22f};
inline constexpr draw2d::Color kDangerText{1.0f, 0.62f, 0.50f};  // on a plate

// A number's plate: its alarm's colour with black figures, else none.
struct Tone {
  AlarmLevel level = AlarmLevel::kOff;
  bool flash = false;
};

// A text that was drawn, for tests of size and contrast.
struct TextMark {
  Box box;            // of its ink, layout units
  double size = 0.0;  // height of capitals, layout units
  FixedText text;
};

class Painter {
 public:
  Painter(draw2d::Canvas& canvas, double scale, std::vector<TextMark>& marks)
      : canvas_(canvas), scale_(scale), marks_(marks) {}

  void plate(const Box& box, double radius, const draw2d::Color& color);
  void line(double x0, double y0, double x1, double y1, double width, const draw2d::Color& color);
  void fill(const Box& box, const draw2d::Color& color);
  void outline(const Box& box, double width, const draw2d::Color& color);
  void triangle(double x, double y, double half, bool up, const draw2d::Color& color);
  void disc(double x, double y, double radius, const draw2d::Color& color);
  void ring(double x, double y, double radius, double width, const draw2d::Color& color);
  void polyline(std::span<const Vec2> points, double width, const draw2d::Color& color);
  // At the baseline. Gives the width.
  double text(double x, double y, double size, std::string_view utf8, const draw2d::Color& color,
              draw2d::Align align = draw2d::Align::kLeft,
              draw2d::Face face = draw2d::Face::kRegular);
  double width(double size, std::string_view utf8, draw2d::Face face);

  // A label over a bold number with its unit; both shrink where the cell is too narrow.
  struct Cell {
    Box box;
    std::string_view label, value, unit;
    double size = 20.0, label_size = 12.0;
    Tone tone;
  };
  void cell(const Cell& cell);

  // A button: its word in a frame, on a bright plate while it is pressed.
  void key(const Box& box, std::string_view word, bool pressed, double size);
  // How full something is, from the left, in kBarSteps; kNoStep: not known.
  void level(const Box& box, std::uint8_t step);

  // The signed rate as begun steps, from the bottom up, with its number and its unit below.
  void ascent_bar(const Box& box, const Shown& shown, double size, double unit_size);
  void tissues(const Box& box, const Shown& shown);
  // 90 degrees of the compass around the heading, which stands in the middle.
  void compass(const Box& box, const Shown& shown, double size);
  // The most pressing alarm with what to do, and how many others there are; nothing without alarms.
  void alarm_band(const Box& box, const Shown& shown, double size);
  // A message: who sent it, and its words in one line or two; nothing without one.
  void message_band(const Box& box, const Shown& shown, double size);

 private:
  draw2d::Canvas& canvas_;
  double scale_;
  std::vector<TextMark>& marks_;
};

Tone tone_of(const Shown& shown, Alarm alarm);
bool any_alarm(const Shown& shown);
// Whether a band lies over a layout that a diver wears: an alarm, else a message.
bool any_band(const Shown& shown);
// The plate's and the figures' colour.
draw2d::Color plate_of(const Tone& tone);
draw2d::Color ink_of(const Tone& tone);

}  // namespace neritic::hud
