// Shapes against their areas, clipping, and text on a picture.
#include "engine/draw2d/canvas.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace neritic::draw2d {
namespace {

constexpr Color kBlack{0, 0, 0}, kWhite{1, 1, 1};

// The area that white covers of a black canvas, in pixels.
double area(const Canvas& canvas) {
  double sum = 0.0;
  for (std::size_t i = 0; i < canvas.image().data.size(); i += 3)
    sum += canvas.image().data[i] / 255.0;
  return sum;
}

template <class Draw>
double area_of(Draw&& draw, std::uint32_t size = 100) {
  Canvas canvas(size, size, kBlack);
  draw(canvas);
  return area(canvas);
}

std::vector<Vec2> regular_polygon(int corners, Vec2 centre, double radius, double turn) {
  std::vector<Vec2> out;
  for (int i = 0; i < corners; ++i) {
    const double a = turn + 2.0 * kPi * i / corners;
    out.push_back(centre + radius * Vec2(std::sin(a), -std::cos(a)));
  }
  return out;
}

TEST(Canvas, AreasAreThoseOfTheShapes) {
  EXPECT_NEAR(area_of([](Canvas& c) { c.fill_rectangle(10.25, 20.5, 30, 41, kWhite); }),
              19.75 * 20.5, 0.3);
  EXPECT_NEAR(area_of([](Canvas& c) { c.disc(50.3, 49.6, 30, kWhite); }), kPi * 900, 5);
  EXPECT_NEAR(area_of([](Canvas& c) { c.segment(10, 20, 80, 70, 3, kWhite); }),
              3 * std::hypot(70, 50) + kPi * 2.25, 3);
  EXPECT_NEAR(area_of([](Canvas& c) { c.arc(50, 50, 30, 0.3, 1.7, 6, kWhite); }), 1.4 * 30 * 6, 4);
  EXPECT_NEAR(area_of([](Canvas& c) { c.arc(50, 50, 30, -kPi, kPi, 6, kWhite); }), 2 * kPi * 30 * 6,
              8);
  for (const int corners : {3, 4, 5, 17, 300})
    for (const double turn : {0.0, 0.1, 1.0}) {
      const auto polygon = regular_polygon(corners, {50.2, 49.9}, 40, turn);
      EXPECT_NEAR(area_of([&](Canvas& c) { c.fill_polygon(polygon, kWhite); }),
                  0.5 * corners * 1600 * std::sin(2 * kPi / corners), 2)
          << corners;
    }
}

TEST(Canvas, APolygonCoversEachPixelByItsExactArea) {
  // Half of a pixel: the triangle under its diagonal.
  Canvas canvas(4, 4, kBlack);
  const std::vector<Vec2> half{{1, 1}, {2, 2}, {1, 2}};
  canvas.fill_polygon(half, kWhite);
  EXPECT_EQ(canvas.image().at(1, 1), 128);
  EXPECT_EQ(canvas.image().at(2, 1), 0);
  // A sliver of a tenth of a pixel's width across three rows.
  const std::vector<Vec2> sliver{{3.0, 0.5}, {3.1, 0.5}, {3.1, 3}, {3.0, 3}};
  canvas.fill_polygon(sliver, kWhite);
  EXPECT_EQ(canvas.image().at(3, 0), 13);
  EXPECT_EQ(canvas.image().at(3, 2), 26);
}

TEST(Canvas, BothDirectionsOfAPolygonFillTheSame) {
  auto polygon = regular_polygon(7, {50, 50}, 30, 0.2);
  Canvas one(100, 100, kBlack), other(100, 100, kBlack);
  one.fill_polygon(polygon, kWhite);
  std::reverse(polygon.begin(), polygon.end());
  other.fill_polygon(polygon, kWhite);
  EXPECT_EQ(one.image().data, other.image().data);
}

TEST(Canvas, WhatCrossesABorderIsCutThere) {
  // Each shape drawn on a large canvas and, moved, on a window of it.
  const auto shapes = [](Canvas& c, double dx, double dy) {
    c.fill_rectangle(-40 + dx, 10 + dy, 20 + dx, 140 + dy, {0.3f, 0.6f, 0.9f, 0.5f});
    c.segment(-80 + dx, -80 + dy, 200 + dx, 120 + dy, 9, kWhite);
    c.disc(100 + dx, 10 + dy, 25, {0.9f, 0.1f, 0.1f, 0.7f});
    c.arc(0 + dx, 100 + dy, 50, -2, 1, 8, {0.2f, 0.9f, 0.1f});
    c.fill_polygon(std::vector<Vec2>{{-50 + dx, 60 + dy}, {160 + dx, 30 + dy}, {50 + dx, 170 + dy}},
                   {0.5f, 0.5f, 0.0f, 0.6f});
    c.polyline(std::vector<Vec2>{{-20 + dx, 50 + dy}, {50 + dx, -30 + dy}, {130 + dx, 90 + dy}}, 5,
               {0.9f, 0.9f, 0.2f, 0.5f});
    c.text(-30 + dx, 30 + dy, 40, "Range 12.5", {0.8f, 0.9f, 1.0f, 0.8f});
    c.text(20 + dx, 112 + dy, 30, "gypsum", kWhite);
  };
  constexpr double kRounding = 4;  // letters stand at multiples of 1/64 pixel, 255 / 64 of coverage
  Canvas large(300, 300, kBlack), window(100, 100, kBlack);
  shapes(large, 100, 100);
  shapes(window, 0, 0);
  for (std::uint32_t y = 0; y < 100; ++y)
    for (std::uint32_t x = 0; x < 100; ++x)
      for (std::uint32_t k = 0; k < 3; ++k)
        ASSERT_NEAR(window.image().at(x, y, k), large.image().at(x + 100, y + 100, k), kRounding)
            << x << ", " << y;
}

TEST(Canvas, FarAndBrokenPlacesDrawNothing) {
  const double nan = std::nan("");
  Canvas canvas(20, 20, kBlack);
  for (const double far : {1e9, -1e9, 1e300}) {
    canvas.segment(far, far, far, far, 5, kWhite);
    canvas.disc(far, 10, 3, kWhite);
    canvas.arc(far, 10, 3, 0, 1, 2, kWhite);
    canvas.fill_rectangle(far, 5, far, 8, kWhite);
    canvas.text(far, 10, 10, "far", kWhite);
    canvas.fill_polygon(std::vector<Vec2>{{far, 0}, {far, 9}, {far, 5}}, kWhite);
  }
  canvas.segment(nan, 1, 5, 5, 2, kWhite);
  canvas.disc(nan, nan, 3, kWhite);
  canvas.fill_polygon(std::vector<Vec2>{{nan, 0}, {9, 9}, {0, 5}}, kWhite);
  canvas.fill_polygon({}, kWhite);
  canvas.polyline({}, 3, kWhite);
  canvas.segment(5, 5, 10, 10, 0, kWhite);
  canvas.segment(5, 5, 10, 10, -2, kWhite);
  canvas.disc(5, 5, 0, kWhite);
  EXPECT_EQ(area(canvas), 0.0);
}

TEST(Canvas, ATranslucentLineIsEvenWhereItBends) {
  Canvas canvas(60, 60, kBlack);
  canvas.polyline(std::vector<Vec2>{{10, 10}, {50, 30}, {10, 50}, {30, 5}}, 6,
                  kWhite.with_alpha(0.5f));
  for (const std::uint8_t v : canvas.image().data) EXPECT_LE(v, 128);
}

TEST(Canvas, TextStandsWhereItsAlignmentSays) {
  struct Side {
    std::uint32_t left = 1000, right = 0, top = 1000, bottom = 0;
  };
  const auto box = [](Align align, VerticalAlign vertical) {
    Canvas canvas(400, 100, kBlack);
    canvas.text(200, 50, 24, "HEIGHT 24H", kWhite, align, Face::kRegular, vertical);
    Side out;
    for (std::uint32_t y = 0; y < 100; ++y)
      for (std::uint32_t x = 0; x < 400; ++x)
        if (canvas.image().at(x, y) > 100)
          out = {std::min(out.left, x), std::max(out.right, x + 1), std::min(out.top, y),
                 std::max(out.bottom, y + 1)};
    return out;
  };
  const double width = Canvas(1, 1, kBlack).text_width(24, "HEIGHT 24H");
  constexpr double kBearing_px = 4;  // of an H
  const Side left = box(Align::kLeft, VerticalAlign::kBaseline);
  EXPECT_NEAR(left.left, 200, kBearing_px);
  EXPECT_NEAR(left.right, 200 + width, kBearing_px);
  EXPECT_NEAR(box(Align::kRight, VerticalAlign::kBaseline).right, 200, kBearing_px);
  const Side centre = box(Align::kCenter, VerticalAlign::kMiddle);
  EXPECT_NEAR((centre.left + centre.right) / 2.0, 200, 1);
  EXPECT_NEAR((centre.top + centre.bottom) / 2.0, 50, 1);
  EXPECT_NEAR(left.bottom, 50, 1);
  EXPECT_NEAR(left.top, 26, 1);
  EXPECT_NEAR(box(Align::kLeft, VerticalAlign::kTop).top, 50, 1);
}

TEST(Canvas, ALongTextIsCutWithAnEllipsis) {
  Canvas canvas(10, 10, kBlack);
  EXPECT_EQ(canvas.shortened(10, "side-scan", 1000), "side-scan");
  const std::string cut = canvas.shortened(10, "side-scan \u03b8\u03b8\u03b8\u03b8", 75);
  EXPECT_LE(canvas.text_width(10, cut), 75);
  EXPECT_TRUE(cut.starts_with("side-s") && cut.ends_with("\u2026")) << cut;
  for (double room = 0; room < 110; room += 1)
    EXPECT_LE(canvas.text_width(10, canvas.shortened(10, "\u03b8\u03b8\u03b8 \u00b0m", room)),
              room);
  EXPECT_EQ(canvas.shortened(10, "side-scan", 1), "");
}

TEST(Canvas, TheSameCallsGiveTheSameBytes) {
  const auto draw = [] {
    Canvas canvas(200, 80, {0.1f, 0.2f, 0.3f});
    canvas.text(7.3, 40, 12.6, "AVATo 45\u00b0 \u03b8 \u00b5Pa", kWhite);
    canvas.fill_polygon(regular_polygon(5, {150, 40}, 30, 0.3), {1, 0.5f, 0, 0.7f});
    return canvas.take();
  };
  EXPECT_EQ(draw().data, draw().data);
}

}  // namespace
}  // namespace neritic::draw2d
