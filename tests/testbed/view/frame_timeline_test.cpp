#include "testbed/view/frame_timeline.hpp"

#include <gtest/gtest.h>

namespace neritic::testbed {
namespace {

TEST(FrameTimeline, PassesComeToTheFrameThatSubmittedThem) {
  FrameTimeline timeline;
  for (TimeNs i = 0; i < 4; ++i) {
    timeline.begin(100 * i + 1);
    timeline.current().begun = 100 * i + 20;
    timeline.current().submitted = 100 * i + 60;
    timeline.end(100 * i + 70, i == 1 ? std::nullopt : std::optional<std::uint64_t>(i + 10));
  }
  const std::vector<gpu::PassTime> passes{{"record", 3.0}, {"shade", 1.0}, {"copy", 2.0}};
  timeline.passes_of(12, passes);
  timeline.passes_of(11, passes);  // nobody's
  ASSERT_EQ(timeline.frames().size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(timeline.frames()[i].number, i);
    EXPECT_EQ(timeline.frames()[i].passes.size(), i == 2 ? 2u : 0u);
  }
  EXPECT_EQ(timeline.frames()[2].passes[0].name, "shade");
}

TEST(FrameTimeline, AFrameThatDidNotEndIsDroppedAndMemoryIsBounded) {
  FrameTimeline timeline;
  timeline.begin(5);
  for (std::size_t i = 0; i < FrameTimeline::kMostFrames + 10; ++i) {
    timeline.begin(static_cast<TimeNs>(i));
    timeline.end(static_cast<TimeNs>(i) + 1, i + 1);
  }
  EXPECT_EQ(timeline.frames().size(), FrameTimeline::kMostFrames);
  EXPECT_EQ(timeline.frames().front().number, 11u);
  timeline.passes_of(3, std::vector<gpu::PassTime>{{"gone", 1.0}});
  EXPECT_TRUE(timeline.frames().front().passes.empty());
}

}  // namespace
}  // namespace neritic::testbed
