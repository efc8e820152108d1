// The exact barriers of small graphs. Drawn as: (a1) version 1 of a, [P] a pass, | a barrier.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "graph_maker.hpp"
#include "simulator.hpp"

namespace neritic::graph {
namespace {

using testing::IsEmpty;
using testing::SizeIs;

constexpr auto kCompute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
constexpr auto kFragment = VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
constexpr auto kColor = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
constexpr VkPipelineStageFlags2 kDepth =
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;

struct Side {
  VkPipelineStageFlags2 stages;
  VkAccessFlags2 access;
  VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
};

void expect_barrier(const Barrier& b, std::uint32_t resource, Side from, Side to,
                    bool discards = false) {
  EXPECT_EQ(b.resource, resource);
  EXPECT_EQ(b.src_stages, from.stages);
  EXPECT_EQ(b.src_access, from.access);
  EXPECT_EQ(b.old_layout, from.layout);
  EXPECT_EQ(b.dst_stages, to.stages);
  EXPECT_EQ(b.dst_access, to.access);
  EXPECT_EQ(b.new_layout, to.layout);
  EXPECT_EQ(b.discards, discards);
}

TEST(Barriers, ComputeWriteToComputeReadOfABuffer) {
  // [make] -> (a1) | [use]
  GraphMaker m;
  const auto a = m.buffer("a");
  m.pass("make", {use(a, 0, kWrite)});
  m.pass("use", {use(a, 1, kRead)}, true);
  const Plan plan = m.plan();
  EXPECT_THAT(barriers_at(plan, 0), IsEmpty());  // fresh memory, no layout
  ASSERT_THAT(barriers_at(plan, 1), SizeIs(1));
  expect_barrier(barriers_at(plan, 1)[0], a, {kCompute, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT},
                 {kCompute, VK_ACCESS_2_SHADER_STORAGE_READ_BIT});
  EXPECT_THAT(barriers_at_end(plan), IsEmpty());
}

TEST(Barriers, ColorAttachmentToSampled) {
  // | [draw] -> (a1) | [shade]
  GraphMaker m;
  const auto a = m.image("a");
  m.pass("draw", {use(a, 0, Access::kColorAttachment)});
  m.pass("shade", {use(a, 1, Access::kSampledFragment)}, true);
  const Plan plan = m.plan();
  ASSERT_THAT(barriers_at(plan, 0), SizeIs(1));
  constexpr VkAccessFlags2 kColorBoth =
      VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT;
  expect_barrier(barriers_at(plan, 0)[0], a, {0, 0},
                 {kColor, kColorBoth, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL}, true);
  ASSERT_THAT(barriers_at(plan, 1), SizeIs(1));
  expect_barrier(
      barriers_at(plan, 1)[0], a,
      {kColor, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL},
      {kFragment, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});
}

TEST(Barriers, DepthWrittenThenTestedThenSampled) {
  // [draw] -> (d1) | [decals] (test only), then | [shade] (sampled)
  GraphMaker m;
  const auto d = m.image("d", VK_FORMAT_D32_SFLOAT);
  m.pass("draw", {use(d, 0, Access::kDepthAttachment)});
  m.pass("decals", {use(d, 1, Access::kDepthTest)}, true);
  m.pass("shade", {use(d, 1, Access::kSampledCompute)}, true);
  const Plan plan = m.plan();
  ASSERT_THAT(barriers_at(plan, 1), SizeIs(1));
  expect_barrier(barriers_at(plan, 1)[0], d,
                 {kDepth, VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
                  VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL},
                 {kDepth, VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT,
                  VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL});
  ASSERT_THAT(barriers_at(plan, 2), SizeIs(1));
  expect_barrier(
      barriers_at(plan, 2)[0], d, {kDepth, 0, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL},
      {kCompute, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});
}

TEST(Barriers, NoneBetweenTwoReadsAndTheFirstServesBothStages) {
  // [make] -> (a1) | [one] (compute), [two] (fragment), [three] (compute)
  GraphMaker m;
  const auto a = m.image("a");
  m.pass("make", {use(a, 0, kWrite)});
  m.pass("one", {use(a, 1, Access::kSampledCompute)}, true);
  m.pass("two", {use(a, 1, Access::kSampledFragment)}, true);
  m.pass("three", {use(a, 1, Access::kSampledCompute)}, true);
  const Plan plan = m.plan();
  ASSERT_THAT(barriers_at(plan, 1), SizeIs(1));
  EXPECT_EQ(barriers_at(plan, 1)[0].dst_stages, kCompute | kFragment);
  EXPECT_THAT(barriers_at(plan, 2), IsEmpty());
  EXPECT_THAT(barriers_at(plan, 3), IsEmpty());
}

TEST(Barriers, WriteAfterReadOnlyWaits) {
  // [make] -> (a1) -> [use]
  //             \-----------| [over] -> (a2)       nothing to make available, only to wait for
  GraphMaker m;
  const auto a = m.buffer("a");
  m.pass("make", {use(a, 0, Access::kTransferWrite)});
  m.pass("use", {use(a, 1, Access::kVertexBuffer)}, true);
  m.pass("over", {use(a, 1, Access::kTransferWrite)}, true);
  const Plan plan = m.plan();
  ASSERT_THAT(barriers_at(plan, 2), SizeIs(1));
  expect_barrier(barriers_at(plan, 2)[0], a, {VK_PIPELINE_STAGE_2_VERTEX_ATTRIBUTE_INPUT_BIT, 0},
                 {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT});
}

TEST(Barriers, MemoryTakenOverWaitsForItsLastOwner) {
  // position   0   1   2
  // a          W   R(fragment)
  // b          .   .   W         in a's bytes
  GraphMaker m;
  const auto a = m.image("a"), b = m.image("b"), keep = m.imported_buffer("keep");
  m.pass("p0", {use(a, 0, Access::kColorAttachment)});
  m.pass("p1", {use(a, 1, Access::kSampledFragment)}, true);
  m.pass("p2", {use(b, 0, kWrite), use(keep, 0, kRead)}, true);
  const Plan plan = m.plan();
  ASSERT_EQ(plan.placement.offset[a], plan.placement.offset[b]);
  ASSERT_THAT(barriers_at(plan, 2), SizeIs(1));
  constexpr VkAccessFlags2 kStorageBoth =
      VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
  expect_barrier(barriers_at(plan, 2)[0], b, {kFragment, 0},
                 {kCompute, kStorageBoth, VK_IMAGE_LAYOUT_GENERAL}, true);
}

TEST(Barriers, MemoryTakenOverFromAWriterMakesItsWritesAvailable) {
  GraphMaker m;
  const auto a = m.buffer("a"), b = m.buffer("b");
  m.pass("p0", {use(a, 0, Access::kTransferWrite)}, true);
  m.pass("p1", {use(b, 0, kWrite)}, true);
  const Plan plan = m.plan();
  ASSERT_THAT(barriers_at(plan, 1), SizeIs(1));
  EXPECT_EQ(barriers_at(plan, 1)[0].src_stages, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT);
  EXPECT_EQ(barriers_at(plan, 1)[0].src_access, VK_ACCESS_2_TRANSFER_WRITE_BIT);
  EXPECT_TRUE(barriers_at(plan, 1)[0].discards);
}

TEST(Barriers, ImportComesFromItsInitialState) {
  GraphMaker m;
  const auto a = m.imported_image("a", kColor, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                                  VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
  m.pass("p", {use(a, 0, Access::kSampledCompute)}, true);
  const Plan plan = m.plan();
  ASSERT_THAT(barriers_at(plan, 0), SizeIs(1));
  expect_barrier(
      barriers_at(plan, 0)[0], a,
      {kColor, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL},
      {kCompute, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});
}

TEST(Barriers, ImportThatIsReadyNeedsNone) {
  GraphMaker m;
  const auto idle = m.imported_image("idle", 0, 0, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
  const auto mesh = m.imported_buffer("mesh");
  const auto read = m.imported_buffer("read", kCompute, VK_ACCESS_2_SHADER_STORAGE_READ_BIT);
  m.pass("p",
         {use(idle, 0, Access::kSampledCompute), use(mesh, 0, Access::kVertexBuffer),
          use(read, 0, kRead)},
         true);
  EXPECT_THAT(barriers_at(m.plan(), 0), IsEmpty());
}

TEST(Barriers, SwapchainImageGoesFromUndefinedToPresent) {
  // | [tonemap] -> (s1) | present
  GraphMaker m;
  const auto s = m.imported_image("swapchain", kColor, 0, VK_IMAGE_LAYOUT_UNDEFINED);
  m.pass("tonemap", {use(s, 0, Access::kColorAttachment)});
  m.output(s, 1, Access::kPresent);
  const Plan plan = m.plan();
  ASSERT_THAT(barriers_at(plan, 0), SizeIs(1));
  EXPECT_TRUE(barriers_at(plan, 0)[0].discards);
  EXPECT_EQ(barriers_at(plan, 0)[0].src_stages, kColor);  // the stage that waits for acquisition
  ASSERT_THAT(barriers_at_end(plan), SizeIs(1));
  expect_barrier(
      barriers_at_end(plan)[0], s,
      {kColor, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL},
      {0, 0, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR});
}

TEST(Barriers, HostReadIsServedAtTheEnd) {
  GraphMaker m;
  const auto a = m.imported_buffer("answers");
  m.pass("p", {use(a, 0, kWrite)});
  m.output(a, 1, Access::kHostRead);
  const Plan plan = m.plan();
  ASSERT_THAT(barriers_at_end(plan), SizeIs(1));
  expect_barrier(barriers_at_end(plan)[0], a, {kCompute, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT},
                 {VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT});
}

TEST(Barriers, ReadThatItsOwnWriteIncludesGivesOneBarrier) {
  GraphMaker m;
  const auto a = m.image("a");
  m.pass("make", {use(a, 0, kWrite)});
  m.pass("more", {use(a, 1, kRead), use(a, 1, kWrite)}, true);
  EXPECT_THAT(barriers_at(m.plan(), 1), SizeIs(1));
}

// --- The judge itself

TEST(Simulator, MissesNoHazardThatWasPlanted) {
  GraphMaker m;
  const auto a = m.image("a");
  m.pass("draw", {use(a, 0, Access::kColorAttachment)});
  m.pass("shade", {use(a, 1, Access::kSampledFragment)}, true);
  const Plan sound = m.plan();
  EXPECT_THAT(find_hazards(sound), IsEmpty());
  const auto spoilt = [&](auto spoil) {
    Plan plan = sound;
    spoil(plan.barriers.before[1][0]);
    return find_hazards(plan);
  };
  EXPECT_THAT(spoilt([](Barrier& b) { b.src_stages = kCompute; }), testing::Not(IsEmpty()));
  EXPECT_THAT(spoilt([](Barrier& b) { b.dst_stages = kCompute; }), testing::Not(IsEmpty()));
  EXPECT_THAT(spoilt([](Barrier& b) { b.src_access = 0; }), testing::Not(IsEmpty()));
  EXPECT_THAT(spoilt([](Barrier& b) { b.dst_access = 0; }), testing::Not(IsEmpty()));
  EXPECT_THAT(spoilt([](Barrier& b) { b.new_layout = VK_IMAGE_LAYOUT_GENERAL; }),
              testing::Not(IsEmpty()));
  EXPECT_THAT(spoilt([](Barrier& b) { b.old_layout = VK_IMAGE_LAYOUT_UNDEFINED; }),
              testing::Not(IsEmpty()));  // would throw the picture away
}

TEST(Simulator, SeesTwoResourcesInTheSameBytes) {
  GraphMaker m;
  const auto a = m.buffer("a"), b = m.buffer("b");
  m.pass("p0", {use(a, 0, kWrite), use(b, 0, kWrite)});
  m.pass("p1", {use(a, 1, kRead), use(b, 1, kRead)}, true);
  Plan plan = m.plan();
  EXPECT_THAT(find_hazards(plan), IsEmpty());
  plan.placement.offset[b] = plan.placement.offset[a];
  EXPECT_THAT(find_hazards(plan), testing::Not(IsEmpty()));
}

}  // namespace
}  // namespace neritic::graph
