// Plots as pictures: axes with ticks and words, lines with markers, bars, a legend. Small on
// purpose. One owner, one thread.
#pragma once

#include <string>
#include <vector>

#include "engine/draw2d/canvas.hpp"

namespace neritic::tools {

struct Axis {
  std::string label;
  double min = 0.0, max = 1.0;  // max below min: it runs the other way (not with log)
  bool log = false;             // then min and max are positive
};

struct Series {
  std::string name;  // empty: not in the legend
  draw2d::Color color;
  std::vector<double> x, y;
  std::vector<std::string> notes = {};  // beside the points; empty: none
  bool joined = true;                   // by lines
  bool marked = true;                   // a dot at each point
};

struct Bar {
  std::string name;
  draw2d::Color color;
  double value = 0.0;
};

struct Box {
  double left = 0, top = 0, right = 0, bottom = 0;  // pixels, axes included
};

// Paper, ink, and colours that tell apart also for the colour-blind (Okabe and Ito 2008).
inline constexpr draw2d::Color kPaper{0.985f, 0.98f, 0.97f}, kInk{0.13f, 0.15f, 0.18f};
inline constexpr draw2d::Color kSeriesColors[] = {{0.0f, 0.447f, 0.698f},
                                                  {0.835f, 0.369f, 0.0f},
                                                  {0.0f, 0.62f, 0.451f},
                                                  {0.8f, 0.475f, 0.655f},
                                                  {0.35f, 0.35f, 0.35f}};

// An axis that holds all values with a little room.
Axis axis_for(const std::string& label, const std::vector<double>& values, bool log);

// The legend lies where it hides the least, nothing where a place is free.
void draw_lines(draw2d::Canvas& canvas, const Box& box, const std::string& title, const Axis& x,
                const Axis& y, const std::vector<Series>& series, bool legend_below = false);
// The numbers at an axis: 1, 2, 5 times powers of ten; of a logarithmic one that holds fewer than
// three of these, equal steps.
std::vector<double> ticks(const Axis& axis);
// Where that legend lies: of places at the right side, then at the left and in the middle, from the
// top (or from below), the first that is free of lines and dots.
Box legend_box(const Box& box, const Axis& x, const Axis& y, const std::vector<Series>& series,
               bool below);
// A number's place on an axis that runs from one pixel to another.
double place(const Axis& axis, double value, double from, double to);
// The rectangle inside the axes of a plot.
Box inside(const Box& box);
// A ring around a point of such a plot, with words.
void draw_mark(draw2d::Canvas& canvas, const Box& box, const Axis& x, const Axis& y, double at_x,
               double at_y, const std::string& words);
void draw_bars(draw2d::Canvas& canvas, const Box& box, const std::string& title,
               const std::string& label, const std::vector<Bar>& bars);

}  // namespace neritic::tools
