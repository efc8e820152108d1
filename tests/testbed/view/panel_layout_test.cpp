// Panels stay within the window and off each other at any size of it.
#include "testbed/view/panel_layout.hpp"

#include <gtest/gtest.h>

#include "testbed/view/dive_panels.hpp"
#include "testbed/view/hud_places.hpp"

namespace neritic::testbed {
namespace {

using hud::LayoutKind;

std::vector<PanelRect> all_of(const PanelLayout& layout) {
  std::vector<PanelRect> out{layout.status, layout.readout, layout.hint};
  out.insert(out.end(), layout.fans.begin(), layout.fans.end());
  out.insert(out.end(), layout.extras.begin(), layout.extras.end());
  return out;
}

void expect_apart_and_inside(const PanelLayout& layout, float width, float height) {
  const auto rects = all_of(layout);
  for (std::size_t i = 0; i < rects.size(); ++i) {
    const PanelRect& a = rects[i];
    if (a.empty()) continue;
    EXPECT_GE(a.x, 0.0f) << i << " at " << width << " x " << height;
    EXPECT_GE(a.y, 0.0f) << i << " at " << width << " x " << height;
    EXPECT_LE(a.right(), width) << i << " at " << width << " x " << height;
    EXPECT_LE(a.bottom(), height) << i << " at " << width << " x " << height;
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_FALSE(overlap(a, rects[j])) << i << " on " << j << " at " << width << " x " << height;
  }
}

// Fans of 90 and 130 degrees, of an acoustic camera, and a row of eight.
const std::vector<std::vector<float>> kFans{
    {}, {0.68f}, {0.68f, 0.55f, 2.0f}, {0.68f, 0.55f, 2.0f, 0.68f, 0.55f, 0.7f, 0.6f, 0.5f}};

// Gauges, a plot, a map, an inset.
const std::vector<PanelWish> kWishes{{170, 110}, {200, 150}, {300, 200}, {213, 213}};

TEST(PanelLayout, NoPanelLeavesTheWindowOrCoversAnother) {
  for (const auto& fans : kFans)
    for (float width = 160; width <= 3840; width += 92)
      for (float height = 90; height <= 2160; height += 61)
        for (const float status : {90.0f, 240.0f, 1500.0f})
          for (std::size_t wishes = 0; wishes <= kWishes.size(); ++wishes)
            expect_apart_and_inside(
                lay_out(width, height, status, fans, std::span(kWishes).first(wishes)), width,
                height);
}

TEST(PanelLayout, FromTheSmallestWindowOnAllHavePlacesAndWideOnesShowEverySonar) {
  for (const auto& fans : kFans)
    for (const auto& [width, height] : {std::pair(640.0f, 480.0f),
                                        {800, 600},
                                        {1280, 720},
                                        {1920, 1080},
                                        {2560, 1080},
                                        {3840, 2160}}) {
      const PanelLayout layout = lay_out(width, height, 200.0f, fans);
      for (const PanelRect& rect : {layout.status, layout.readout, layout.hint})
        EXPECT_FALSE(rect.empty()) << width;
      EXPECT_GE(layout.status.height, 200.0f) << width;
      const std::size_t least = width < 1280 ? 1 : 3;
      EXPECT_GE(layout.fans.size(), std::min(least, fans.size())) << width;
      // A diver looks at the middle of the picture.
      const PanelRect middle{0.4f * width, 0.4f * height, 0.1f * width, 0.2f * height};
      for (const PanelRect& rect : all_of(layout))
        EXPECT_FALSE(width >= 1280 && overlap(rect, middle)) << width;
    }
}

TEST(PanelLayout, ADiversInstrumentKeepsItsCorner) {
  for (const auto& fans : kFans)
    for (const auto& [width, height] : {std::pair(640.0f, 480.0f), {1280, 720}, {1920, 1080}}) {
      const PanelRect corner{width - 307.0f, height - 235.0f, 300.0f, 225.0f};
      const PanelLayout layout =
          lay_out(width, height, 200.0f, fans, kWishes, std::span(&corner, 1));
      for (const PanelRect& rect : all_of(layout)) EXPECT_FALSE(overlap(rect, corner)) << width;
      EXPECT_GT(layout.readout.width, 250.0f) << width;
    }
}

// Each layout of instruments alone and all that fit beside each other, in windows of any size.
const std::vector<std::vector<LayoutKind>> kWorn{
    {LayoutKind::kCorner},
    {LayoutKind::kMask},
    {LayoutKind::kWrist},
    {LayoutKind::kConsole},
    {LayoutKind::kWrist, LayoutKind::kMask},
    {LayoutKind::kCorner, LayoutKind::kMask},
    {LayoutKind::kMask, LayoutKind::kCorner, LayoutKind::kWrist}};

TEST(PanelLayout, NoPanelCoversAnInstrumentAndNoInstrumentAnother) {
  hud::Shown console;
  console.condition.known = true;
  console.stream_count = 6;
  for (const auto& worn : kWorn)
    for (std::uint32_t width = 100; width <= 2600; width += 59)
      for (std::uint32_t height = 90; height <= 1500; height += 47) {
        const auto w = static_cast<float>(width), h = static_cast<float>(height);
        std::vector<PanelRect> taken;
        const auto places = hud_places(worn, width, height);
        for (std::size_t i = 0; i < places.size(); ++i) {
          const PanelRect& a = places[i].rect;
          EXPECT_TRUE(a.x >= 0.0f && a.y >= 0.0f && a.right() <= w + 1.0f && a.bottom() <= h)
              << i << " at " << width << " x " << height;
          for (std::size_t j = 0; j < i; ++j)
            EXPECT_FALSE(overlap(a, places[j].rect)) << width << " x " << height;
          for (const PanelRect& rect : taken_by(places[i], console)) taken.push_back(rect);
        }
        const PanelLayout layout = lay_out(w, h, 200.0f, kFans[2], kWishes, taken);
        expect_apart_and_inside(layout, w, h);
        for (const PanelRect& panel : all_of(layout))
          for (const PanelRect& instrument : taken)
            EXPECT_FALSE(overlap(panel, instrument)) << width << " x " << height;
      }
}

TEST(PanelLayout, AllInstrumentsButTheConsoleHavePlacesInOneWindow) {
  const auto& all = kWorn.back();
  for (const auto& [width, height] : {std::pair(1280u, 720u), {1920u, 1080u}, {2560u, 1440u}}) {
    EXPECT_EQ(hud_places(all, width, height).size(), 3u);
    for (const HudPlace& place : hud_places(all, width, height))
      EXPECT_FALSE(place.rect.empty()) << width;
  }
  EXPECT_TRUE(fit_one_window(all));
  EXPECT_TRUE(fit_one_window(std::vector{LayoutKind::kConsole}));
  EXPECT_FALSE(fit_one_window(std::vector{LayoutKind::kConsole, LayoutKind::kWrist}));
}

// The whole console, also where the window is less wide than it.
TEST(PanelLayout, TheConsoleLiesWithinANarrowWindow) {
  const PanelRect rect = hud_places(std::vector{LayoutKind::kConsole}, 800, 600)[0].rect;
  EXPECT_EQ(rect.width, 800.0f);
  EXPECT_EQ(rect.height, 450.0f);
}

// At least as wide as their text; in a window that is too small for them they are left out.
TEST(PanelLayout, NoPanelIsNarrowerThanWhatStandsInIt) {
  for (const auto& worn : kWorn)
    for (const auto& [width, height] :
         {std::pair(1280u, 160u), {401u, 303u}, {300u, 200u}, {100u, 900u}, {160u, 90u}}) {
      std::vector<PanelRect> taken;
      for (const HudPlace& place : hud_places(worn, width, height))
        for (const PanelRect& rect : taken_by(place, {})) taken.push_back(rect);
      const PanelLayout layout = lay_out(static_cast<float>(width), static_cast<float>(height),
                                         200.0f, kFans[2], kWishes, taken);
      EXPECT_TRUE(layout.readout.empty() || layout.readout.width >= 250.0f) << width;
      EXPECT_TRUE(layout.status.empty() || layout.status.width >= 200.0f) << width;
      EXPECT_TRUE(layout.hint.empty() || layout.hint.width >= 130.0f) << width;
      for (const PanelRect& rect : layout.extras)
        EXPECT_TRUE(rect.empty() || rect.width >= 190.0f) << width;
    }
}

TEST(PanelLayout, TheHintNamesWhatHasNoRoom) {
  const PanelLayout small = lay_out(640, 300, 130, kFans[1], kWishes);
  const std::vector<std::string> names{"gauges", "graphs", "map", "inset"};
  const std::string words = hint_words("F1  keys", names, small, 1, "Tab");
  ASSERT_FALSE(small.hint.empty());
  for (std::size_t i = 0; i < names.size(); ++i)
    EXPECT_EQ(words.find(names[i]) != std::string::npos, small.extras[i].empty()) << words;
  EXPECT_EQ(words.starts_with("no room: "), true) << words;
  EXPECT_NE(words.find("map"), std::string::npos) << words;
  EXPECT_NE(words.find("F1  keys"), std::string::npos) << words;
  const PanelLayout wide = lay_out(1920, 1080, 200, kFans[2]);
  EXPECT_EQ(hint_words("F1", {}, wide, wide.fans.size() + 1, "T"), "F1   T  1 more sonar");
  EXPECT_EQ(hint_words("F1", {}, wide, wide.fans.size() + 2, ""), "F1   2 more sonars");
}

TEST(PanelLayout, PanelsOnDemandComeBeforeFansAndFitTheSmallestWindowByOne) {
  for (const auto& wish : kWishes) {
    const PanelLayout layout = lay_out(640, 480, 130, kFans[2], std::span(&wish, 1));
    ASSERT_EQ(layout.extras.size(), 1u);
    EXPECT_GE(layout.extras[0].height, wish.least);
    EXPECT_LE(layout.extras[0].height, wish.wanted);
  }
  const PanelLayout wide = lay_out(1920, 1080, 200, kFans[1], kWishes);
  for (std::size_t i = 0; i < kWishes.size(); ++i)
    EXPECT_EQ(wide.extras[i].height, kWishes[i].wanted) << i;
  EXPECT_EQ(wide.fans.size(), 1u);
}

}  // namespace
}  // namespace neritic::testbed
