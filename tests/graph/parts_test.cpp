// Parts of images in plans: a pass may use one mip or layer while another is written. Drawn as:
// (a1.m0) mip 0 of version 1 of a, [P] a pass, | a barrier.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "graph_maker.hpp"
#include "simulator.hpp"

namespace neritic::graph {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr Access kSample = Access::kSampledCompute;

// [base] -> (a1.m0) -> [one] -> (a2.m1) -> [two] -> (a3.m2) ; [show] samples all of a3
GraphMaker pyramid() {
  GraphMaker m;
  const auto a = m.image("a");
  m.graph.resources[a].mips = 3;
  m.graph.resources[a].layers = 2;
  m.pass("base", {use(a, 0, Access::kColorAttachment, mip(0))});
  m.pass("one", {use(a, 1, kSample, mip(0)), use(a, 1, kWrite, mip(1))});
  m.pass("two", {use(a, 2, kSample, mip(1)), use(a, 2, kWrite, mip(2))});
  m.pass("show", {use(a, 3, kSample)}, true);
  return m;
}

void expect_change(const Barrier& b, const ImageRange& range, VkImageLayout from,
                   VkImageLayout to) {
  EXPECT_EQ(b.range, range);
  EXPECT_EQ(b.old_layout, from);
  EXPECT_EQ(b.new_layout, to);
}

TEST(Parts, APyramidChangesEachMipWhenItIsUsed) {
  const Plan plan = pyramid().plan();
  EXPECT_THAT(find_hazards(plan), IsEmpty());
  const ImageRange m0{0, 1, 0, 2}, m1{1, 1, 0, 2}, m2{2, 1, 0, 2};
  constexpr auto kNone = VK_IMAGE_LAYOUT_UNDEFINED, kGeneral = VK_IMAGE_LAYOUT_GENERAL,
                 kColor = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                 kShader = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
  std::vector<std::vector<Barrier>> before;
  for (std::size_t position = 0; position < 4; ++position)
    before.push_back(barriers_at(plan, position));
  ASSERT_THAT(before[0], SizeIs(1));
  expect_change(before[0][0], m0, kNone, kColor);
  ASSERT_THAT(before[1], SizeIs(2));
  expect_change(before[1][0], m1, kNone, kGeneral);
  expect_change(before[1][1], m0, kColor, kShader);
  ASSERT_THAT(before[2], SizeIs(2));
  expect_change(before[2][0], m2, kNone, kGeneral);
  expect_change(before[2][1], m1, kGeneral, kShader);
  ASSERT_THAT(before[3], SizeIs(1));  // the mips above are readable already
  expect_change(before[3][0], m2, kGeneral, kShader);
}

TEST(Parts, PartsThatChangeAlikeShareABarrier) {
  // [make] -> (a1.l0) -> [more] -> (a2.l1) | [show] samples both
  GraphMaker m;
  const auto a = m.image("a");
  m.graph.resources[a].mips = 2;
  m.graph.resources[a].layers = 2;
  m.pass("make", {use(a, 0, kWrite, layer(0))});
  m.pass("more", {use(a, 1, kWrite, layer(1))});
  m.pass("show", {use(a, 2, kSample)}, true);
  const Plan plan = m.plan();
  EXPECT_THAT(barriers_at(plan, 0), SizeIs(1));
  EXPECT_THAT(barriers_at(plan, 1), SizeIs(1));
  ASSERT_THAT(barriers_at(plan, 2), SizeIs(1));
  EXPECT_EQ(barriers_at(plan, 2)[0].range, (ImageRange{0, 2, 0, 2}));
}

TEST(Parts, AWriteOfAnotherLayerIsNotNeeded) {
  // [left] -> (a1.l0) -> [right] -> (a2.l1) ; output (a2.l0)
  GraphMaker m;
  const auto a = m.image("a");
  m.graph.resources[a].layers = 2;
  m.pass("left", {use(a, 0, kWrite, layer(0))});
  m.pass("right", {use(a, 1, kWrite, layer(1))});
  m.graph.outputs.push_back(use(a, 2, kSample, layer(0)));
  EXPECT_THAT(cull(m.graph), ElementsAre(true, false));
  m.graph.outputs[0].range = {};
  EXPECT_THAT(cull(m.graph), ElementsAre(true, true));
}

TEST(Parts, ALayerMayBeWrittenWhileAnotherIsSampled) {
  GraphMaker m;
  const auto a = m.image("a");
  m.graph.resources[a].layers = 3;
  m.pass("make", {use(a, 0, Access::kTransferWrite, layer(0))});
  m.pass("P", {use(a, 1, kSample, layer(0)), use(a, 1, kWrite, layer(2))}, true);
  EXPECT_THAT(m.error(), IsEmpty());
  EXPECT_THAT(find_hazards(m.plan()), IsEmpty());
}

TEST(Parts, AHandleGoesStaleOnlyByAWriteOfItsPart) {
  // [base] -> (a1.m0) ; [one] -> (a2.m1) ; [late] reads (a1.m0), or (a1.m0) after [over] -> (a3.m0)
  GraphMaker m;
  const auto a = m.image("alga");
  m.graph.resources[a].mips = 2;
  m.pass("base", {use(a, 0, kWrite, mip(0))});
  m.pass("one", {use(a, 1, kWrite, mip(1))});
  GraphMaker stale = m;
  m.pass("late", {use(a, 1, kSample, mip(0))}, true);
  EXPECT_THAT(m.error(), IsEmpty());
  stale.pass("over", {use(a, 2, kWrite, mip(0))});
  stale.pass("late", {use(a, 1, kSample, mip(0))}, true);
  EXPECT_THAT(stale.error(), AllOf(HasSubstr("stale"), HasSubstr("\"late\""), HasSubstr("alga"),
                                   HasSubstr("\"over\"")));
}

TEST(Parts, ReadOfAPartThatNobodyWroteIsRefused) {
  GraphMaker m;
  const auto a = m.image("alga");
  m.graph.resources[a].mips = 2;
  m.pass("base", {use(a, 0, kWrite, mip(0))});
  GraphMaker part = m;
  m.pass("P", {use(a, 1, kSample)}, true);
  EXPECT_THAT(m.error(), AllOf(HasSubstr("\"P\" reads \"alga\" before any pass has written all"),
                               HasSubstr("alga")));
  part.pass("P", {use(a, 1, kSample, mip(1))}, true);
  EXPECT_THAT(part.error(), HasSubstr("\"P\" reads mip 1, layer 0 of \"alga\" before any pass"));
}

TEST(Parts, OnePassMayWriteTwoPartsButNotOneTwice) {
  GraphMaker m;
  const auto a = m.image("alga");
  m.graph.resources[a].mips = 2;
  GraphMaker twice = m;
  m.pass("P", {use(a, 0, kWrite, mip(0)), use(a, 1, kWrite, mip(1))}, true);
  EXPECT_THAT(m.error(), IsEmpty());
  EXPECT_THAT(find_hazards(m.plan()), IsEmpty());
  twice.pass("P", {use(a, 0, kWrite, mip(0)), use(a, 1, kWrite)}, true);
  EXPECT_THAT(twice.error(), AllOf(HasSubstr("twice"), HasSubstr("\"P\""), HasSubstr("alga")));
}

TEST(Parts, PartsThatTheImageLacksAreRefused) {
  GraphMaker m;
  const auto a = m.image("alga");
  m.graph.resources[a].mips = 3;
  GraphMaker mips = m;
  m.pass("P", {use(a, 0, kWrite, mip(3))});
  EXPECT_THAT(m.error(), AllOf(HasSubstr("mip 3, layer 0"), HasSubstr("\"P\""),
                               HasSubstr("which has mips 0 to 2, layer 0")));
  mips.graph.resources[a].mips = 8;  // 64 x 32 has seven
  EXPECT_THAT(mips.error(), AllOf(HasSubstr("8 mips"), HasSubstr("at most 7")));
}

TEST(Parts, AreNamedInDumps) {
  const Plan plan = pyramid().plan();
  const std::string text = dump_text(plan);
  EXPECT_THAT(text, HasSubstr("reads  a [mip 0, layers 0 to 1] 1 (sampled compute)"));
  EXPECT_THAT(text, HasSubstr("writes a [mip 1, layers 0 to 1] 1->2 (storage write compute)"));
  EXPECT_THAT(text, HasSubstr("barrier a [mip 2, layers 0 to 1]: none -> compute"));
  EXPECT_THAT(text, HasSubstr("R8G8B8A8_UNORM 64x32x2, 3 mips"));
  EXPECT_THAT(dump_graphviz(plan), HasSubstr("storage write compute\\nmip 1, layers 0 to 1"));
}

}  // namespace
}  // namespace neritic::graph
