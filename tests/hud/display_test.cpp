// The display on a diver's wrist: what it says, that it follows from the data alone, and that its
// texts fit.
#include "hud/display.hpp"

#include <gtest/gtest.h>

#include "tests/hud/dives.hpp"

namespace neritic::hud {
namespace {

struct DrawnDisplay {
  ImageU8 picture;
  std::vector<TextMark> marks;
  bool says(std::string_view text) const {
    return std::ranges::any_of(marks,
                               [&](const TextMark& mark) { return mark.text.view() == text; });
  }
};

DrawnDisplay display_of(const DiveData& data, Units units = Units::kMetric) {
  draw2d::Canvas canvas(ImageU8(kDisplayWidth_px, kDisplayHeight_px, 4));
  DrawnDisplay out;
  Painter painter(canvas, 1.0, out.marks);
  draw_display(painter, shown_on_display(units, data, data.time_s));
  out.picture = canvas.image();
  return out;
}

TEST(WristDisplay, SaysDepthTimeAndNoStopTime) {
  const DrawnDisplay display = display_of(calm_dive());
  // As the instrument of the wrist says them.
  const Shown worn = shown_of(LayoutKind::kWrist, Units::kMetric, calm_dive(), {}, {}, {}, 0.0);
  for (const std::string_view text :
       {std::string_view("DEPTH m"), worn.depth.view(), std::string_view("NO STOP"),
        worn.no_stop.view(), std::string_view("TIME"), worn.dive_time.view(),
        std::string_view("DEEPEST"), worn.deepest.view(), worn.tank.view(), worn.to_surface.view()})
    EXPECT_TRUE(display.says(text)) << text;
  EXPECT_TRUE(display_of(calm_dive(), Units::kImperial).says("DEPTH ft"));
}

TEST(WristDisplay, SaysStopAndCeilingWhereTheyAreOwed) {
  const DrawnDisplay display = display_of(stops_dive());
  const Shown worn = shown_of(LayoutKind::kWrist, Units::kMetric, stops_dive(), {}, {}, {}, 0.0);
  for (const std::string_view text :
       {std::string_view("STOP m"), worn.stop.view(), worn.stop_min.view(),
        std::string_view("CEILING"), worn.ceiling.view(), worn.dive_time.view()})
    EXPECT_TRUE(display.says(text)) << text;
  EXPECT_FALSE(display.says("NO STOP"));
  EXPECT_FALSE(display.says("DEEPEST"));
}

TEST(WristDisplay, AnAlarmHasTheLastRow) {
  const DiveData data = alarmed_dive(Alarm::kCeiling, AlarmLevel::kDanger);
  const DrawnDisplay display = display_of(data);
  EXPECT_TRUE(display.says(shown_on_display(Units::kMetric, data, data.time_s).advice.what.view()));
  EXPECT_FALSE(display.says("TO SURFACE"));
}

// Whoever looked before: an alarm that is over leaves nothing behind.
TEST(WristDisplay, FollowsFromTheDataAlone) {
  const ImageU8 before = display_of(calm_dive()).picture;
  display_of(alarmed_dive(Alarm::kGas, AlarmLevel::kDanger));
  EXPECT_EQ(display_of(calm_dive()).picture.data, before.data);
  EXPECT_NE(display_of(stops_dive()).picture.data, before.data);
  for (std::size_t alpha = 3; alpha < before.data.size(); alpha += 4)
    ASSERT_EQ(before.data[alpha], 255);
}

TEST(WristDisplay, ItsTextsLieWithinItAndApart) {
  DiveData longest = stops_dive();
  longest.depth_m = longest.deepest_m = 128.7;
  longest.dive_min = 1234.0;
  longest.to_surface_min = 5000.0;
  longest.ceiling_m = longest.stop_m = 98.0;
  longest.stop_min = 5000.0;
  for (const Units units : {Units::kMetric, Units::kImperial})
    for (const DiveData& data : {calm_dive(), stops_dive(), longest, DiveData()}) {
      const auto marks = display_of(data, units).marks;
      for (std::size_t i = 0; i < marks.size(); ++i) {
        const Box& a = marks[i].box;
        EXPECT_TRUE(a.x >= 0.0 && a.y >= 0.0 && a.right() <= kDisplayWidth_px &&
                    a.bottom() <= kDisplayHeight_px)
            << marks[i].text.view();
        for (std::size_t k = 0; k < i; ++k) {
          const Box& b = marks[k].box;
          constexpr double kGap = 2.0;  // figures reach a little beyond their capitals' box
          EXPECT_FALSE(a.x < b.right() + kGap && b.x < a.right() + kGap &&
                       a.y < b.bottom() + kGap && b.y < a.bottom() + kGap)
              << marks[i].text.view() << " over " << marks[k].text.view();
        }
      }
    }
}

}  // namespace
}  // namespace neritic::hud
