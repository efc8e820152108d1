// The axes of plots; legends, which lie where no curve runs.
#include "tools/common/plot.hpp"

#include <gtest/gtest.h>

namespace neritic::tools {
namespace {

TEST(PlotTicks, AreOneTwoFiveTimesPowersOfTen) {
  EXPECT_EQ(ticks({"", 1.0, 100.0, true}),
            (std::vector<double>{1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0}));
  EXPECT_EQ(ticks({"", 0.0, 6.0, false}), (std::vector<double>{0, 1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(ticks({"", 6.0, 0.0, false}), (std::vector<double>{0, 1, 2, 3, 4, 5, 6}));
}

TEST(PlotTicks, ALogarithmicAxisOfLessThanADecadeHasEnough) {
  EXPECT_EQ(ticks({"", 28.0, 92.0, true}), (std::vector<double>{40.0, 60.0, 80.0}));
  EXPECT_EQ(ticks({"", 3.0, 4.0, true}).size(), 6u);  // 3, 3.2, ... 4
}

constexpr Box kPlot{0.0, 0.0, 800.0, 600.0};
const Axis kAcross{"time, s", 0.0, 100.0}, kUp{"m", 0.0, 10.0};

Series line_through(const std::string& name, const std::vector<double>& x,
                    const std::vector<double>& y) {
  return {name, kSeriesColors[0], x, y};
}

// Points along all lines, close together, that lie in a box.
int points_in(const Box& box, const std::vector<Series>& series) {
  const Box in = inside(kPlot);
  int found = 0;
  for (const Series& s : series)
    for (std::size_t i = 1; i < s.x.size(); ++i)
      for (double t = 0.0; t <= 1.0; t += 1e-3) {
        const double x = place(kAcross, s.x[i - 1] + t * (s.x[i] - s.x[i - 1]), in.left, in.right);
        const double y = place(kUp, s.y[i - 1] + t * (s.y[i] - s.y[i - 1]), in.bottom, in.top);
        found += x > box.left && x < box.right && y > box.top && y < box.bottom;
      }
  return found;
}

TEST(Plot, LegendLiesClearOfTheCurves) {
  const std::vector<Series> nothing{line_through("one", {}, {}), line_through("two", {}, {})};
  const Box usual = legend_box(kPlot, kAcross, kUp, nothing, false);
  EXPECT_GT(usual.right, 0.9 * kPlot.right);
  EXPECT_LT(usual.bottom, 0.2 * kPlot.bottom);
  EXPECT_GT(legend_box(kPlot, kAcross, kUp, nothing, true).top, 0.7 * kPlot.bottom);

  const std::vector<Series> dives[] = {
      // Along the top, as heights over a ground far below.
      {line_through("rov", {0, 50, 100}, {9, 9.8, 9.5}),
       line_through("ground below", {0, 100}, {0.5, 0.6})},
      // Along the right side.
      {line_through("rov", {0, 90, 90}, {5, 0, 10}), line_through("diver", {85, 97}, {10, 0})},
      // Along both sides: the middle is free.
      {line_through("rov", {95, 80, 95, 80, 95}, {0, 2.5, 5, 7.5, 10}),
       line_through("diver", {5, 20, 5, 20, 5}, {0, 2.5, 5, 7.5, 10})}};
  for (const auto& series : dives) {
    EXPECT_GT(points_in(inside(kPlot), series), 1000);
    const Box box = legend_box(kPlot, kAcross, kUp, series, false);
    EXPECT_EQ(points_in(box, series), 0) << box.left << " " << box.top;
    EXPECT_GE(box.left, inside(kPlot).left);
    EXPECT_LE(box.right, inside(kPlot).right);
    EXPECT_GE(box.top, inside(kPlot).top);
    EXPECT_LE(box.bottom, inside(kPlot).bottom);
  }
}

TEST(Plot, WhereNoPlaceIsFreeTheLegendHidesTheLeast) {
  std::vector<Series> series;
  for (int i = 0; i < 100; ++i)  // all over, but thin at the lower left
    series.push_back(line_through(i == 0 ? "one" : "", {0.0, 100.0}, {0.1 * i, 0.1 * i}));
  for (int i = 0; i < 40; ++i)
    series.push_back(line_through("", {40.0, 100.0}, {0.1 * i, 0.1 * i + 0.05}));
  for (int i = 40; i < 100; ++i)
    series.push_back(line_through("", {0.0, 100.0}, {0.1 * i, 0.1 * i + 0.05}));
  const Box box = legend_box(kPlot, kAcross, kUp, series, false);
  EXPECT_LT(box.right, 0.4 * kPlot.right);
  EXPECT_GT(box.top, 0.5 * kPlot.bottom);
}

}  // namespace
}  // namespace neritic::tools
