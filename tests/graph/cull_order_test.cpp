// The passes that run, and their order. Drawn as: (a1) version 1 of a, [P] a pass.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "graph_maker.hpp"

namespace neritic::graph {
namespace {

using testing::ElementsAre;

TEST(Cull, KeepsOnlyWhatAnOutputNeeds) {
  // [make] -> (a1) -> [use]   -> (b1) -> output
  //             \---> [waste] -> (c1)
  //                     [waste2] <-/ -> (d1)
  GraphMaker m;
  const auto a = m.image("a"), b = m.image("b"), c = m.image("c"), d = m.image("d");
  m.pass("make", {use(a, 0, kWrite)});
  m.pass("waste", {use(a, 1, kRead), use(c, 0, kWrite)});
  m.pass("waste2", {use(c, 1, kRead), use(d, 0, kWrite)});
  m.pass("use", {use(a, 1, kRead), use(b, 0, kWrite)});
  m.output(b, 1, Access::kTransferRead);
  EXPECT_THAT(cull(m.graph), ElementsAre(true, false, false, true));
}

TEST(Cull, KeepsSideEffectsAndWhatTheyNeed) {
  // [make] -> (a1) -> [tell]!
  GraphMaker m;
  const auto a = m.image("a"), b = m.image("b");
  m.pass("make", {use(a, 0, kWrite)});
  m.pass("alone", {use(b, 0, kWrite)});
  m.pass("tell", {use(a, 1, kRead)}, true);
  EXPECT_THAT(cull(m.graph), ElementsAre(true, false, true));
}

TEST(Cull, KeepsEarlierWritersOfTheSameResource) {
  // [clear] -> (a1) -> [draw] -> (a2) -> [more] -> (a3) -> output    draw keeps what clear wrote
  GraphMaker m;
  const auto a = m.image("a");
  m.pass("clear", {use(a, 0, Access::kTransferWrite)});
  m.pass("draw", {use(a, 1, Access::kColorAttachment)});
  m.pass("more", {use(a, 2, Access::kColorAttachment)});
  m.output(a, 3, Access::kTransferRead);
  EXPECT_THAT(cull(m.graph), ElementsAre(true, true, true));
}

TEST(Cull, WriteToAnImportAloneKeepsNoPass) {
  GraphMaker m;
  const auto a = m.imported_buffer("a");
  m.pass("write", {use(a, 0, kWrite)});
  EXPECT_THAT(cull(m.graph), ElementsAre(false));
}

TEST(Cull, LaterWriterThatNobodyNeedsGoes) {
  // [make] -> (a1) -> [use] -> (b1) -> output
  //             \---> [spoil] -> (a2)
  GraphMaker m;
  const auto a = m.image("a"), b = m.image("b");
  m.pass("make", {use(a, 0, kWrite)});
  m.pass("use", {use(a, 1, kRead), use(b, 0, kWrite)});
  m.pass("spoil", {use(a, 1, kWrite)});
  m.output(b, 1, Access::kTransferRead);
  EXPECT_THAT(cull(m.graph), ElementsAre(true, true, false));
}

TEST(Cull, EmptyGraphGivesAnEmptyPlan) {
  const Plan plan = GraphMaker{}.plan();
  EXPECT_TRUE(plan.order.empty());
  EXPECT_TRUE(barriers_at_end(plan).empty());
  EXPECT_FALSE(dump_text(plan).empty());
}

TEST(Order, DiamondStaysInDeclarationOrder) {
  //            /-> [left]  -> (b1) -\.
  // [make] -> (a1)                   [join] -> (d1)
  //            \-> [right] -> (c1) -/
  GraphMaker m;
  const auto a = m.image("a"), b = m.image("b"), c = m.image("c"), d = m.image("d");
  m.pass("make", {use(a, 0, kWrite)});
  m.pass("right", {use(a, 1, kRead), use(c, 0, kWrite)});
  m.pass("left", {use(a, 1, kRead), use(b, 0, kWrite)});
  m.pass("join", {use(b, 1, kRead), use(c, 1, kRead), use(d, 0, kWrite)});
  EXPECT_THAT(order(m.graph, {true, true, true, true}), ElementsAre(0, 1, 2, 3));
}

TEST(Order, FollowsDependenciesNotPositions) {
  // Plain data may list passes in any order: [show] is listed first but reads what [make] writes,
  // and [over] may overwrite a1 only when [show] has read it.
  //   [make] -> (a1) -> [show]
  //               \---> [over] -> (a2)
  GraphMaker m;
  const auto a = m.image("a");
  m.pass("over", {use(a, 1, kWrite)});
  m.pass("show", {use(a, 1, kRead)});
  m.pass("make", {use(a, 0, kWrite)});
  EXPECT_THAT(order(m.graph, {true, true, true}), ElementsAre(2, 1, 0));
}

TEST(Order, LeavesCulledPassesOut) {
  GraphMaker m;
  const auto a = m.image("a");
  m.pass("make", {use(a, 0, kWrite)});
  m.pass("gone", {use(a, 1, kRead)});
  m.pass("stay", {use(a, 1, kRead)});
  EXPECT_THAT(order(m.graph, {true, false, true}), ElementsAre(0, 2));
}

}  // namespace
}  // namespace neritic::graph
