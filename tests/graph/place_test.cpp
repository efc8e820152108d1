// Lifetimes and the memory of transients, in numbers that can be checked by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "graph_maker.hpp"

namespace neritic::graph {
namespace {

// position   0      1      2      3
// a (100)    W      R
// b (60)            W      R
// c (90)                   W      R -> d
// d (10)                          W -> output
GraphMaker chain() {
  GraphMaker m;
  const auto a = m.buffer("a", 100), b = m.buffer("b", 60), c = m.buffer("c", 90),
             d = m.buffer("d", 10);
  m.pass("p0", {use(a, 0, kWrite)});
  m.pass("p1", {use(a, 1, kRead), use(b, 0, kWrite)});
  m.pass("p2", {use(b, 1, kRead), use(c, 0, kWrite)});
  m.pass("p3", {use(c, 1, kRead), use(d, 0, kWrite)});
  m.output(d, 1, Access::kHostRead);
  return m;
}

TEST(Lifetimes, SpanFirstToLastTouch) {
  const Plan plan = chain().plan();
  EXPECT_EQ(plan.lifetimes[0].first, 0u);
  EXPECT_EQ(plan.lifetimes[0].last, 1u);
  EXPECT_EQ(plan.lifetimes[2].first, 2u);
  EXPECT_EQ(plan.lifetimes[2].last, 3u);
}

TEST(Lifetimes, OutputsLiveToTheEnd) {
  GraphMaker m = chain();
  m.graph.outputs.push_back({0, 1, Access::kHostRead});
  EXPECT_EQ(m.plan().lifetimes[0].last, 3u);
}

TEST(Lifetimes, WhatOnlyCulledPassesTouchIsUnused) {
  GraphMaker m = chain();
  const auto e = m.buffer("e", 1 << 20);
  m.pass("waste", {use(e, 0, kWrite)});
  const Plan plan = m.plan();
  EXPECT_FALSE(plan.lifetimes[e].used());
  EXPECT_LT(plan.placement.bytes_without, 1u << 20);
}

TEST(Place, ChainNeedsTwoNeighboursAtATime) {
  // c takes over a's bytes: 100 + 60, and d (10) fits beside c where a ended.
  const Plan plan = chain().plan();
  EXPECT_EQ(plan.placement.bytes_without, 260u);
  EXPECT_EQ(plan.placement.bytes_with_aliasing, 160u);
  EXPECT_EQ(plan.placement.offset[0], plan.placement.offset[2]);
}

TEST(Place, HonoursAlignment) {
  const GraphMaker m = chain();
  const Result<Plan> plan = plan_with(m.graph, m.needs(64));
  ASSERT_TRUE(plan.ok());
  for (std::size_t r = 0; r < 4; ++r) EXPECT_EQ(plan->placement.offset[r] % 64, 0u);
  EXPECT_EQ(plan->placement.bytes_with_aliasing, 128u + 60u);
}

TEST(Place, ClassesNeverShare) {
  const GraphMaker m = chain();
  std::vector<MemoryNeed> needs = m.needs();
  for (std::uint32_t r = 0; r < 4; ++r) needs[r].memory_class = r;
  const Result<Plan> plan = plan_with(m.graph, needs);
  ASSERT_TRUE(plan.ok());
  EXPECT_THAT(plan->placement.heap_size, testing::ElementsAre(100, 60, 90, 10));
  EXPECT_EQ(plan->placement.bytes_with_aliasing, plan->placement.bytes_without);
}

TEST(Place, TakesTheSmallestGapThatFits) {
  // Long-lived walls leave gaps of 40 and 20 when the short-lived leave; e (20) takes the 20.
  //   | w0 100 | s0 40 | ...  all alive at 0; s* die after 0; e is born at 1
  GraphMaker m;
  const auto w0 = m.buffer("w0", 100), w1 = m.buffer("w1", 39), w2 = m.buffer("w2", 19);
  const auto s0 = m.buffer("s0", 40), s1 = m.buffer("s1", 20), e = m.buffer("e", 18);
  m.pass("p0", {use(w0, 0, kWrite), use(w1, 0, kWrite), use(w2, 0, kWrite), use(s0, 0, kWrite),
                use(s1, 0, kWrite)});
  m.pass("p1", {use(e, 0, kWrite), use(w0, 1, kRead), use(w1, 1, kRead), use(w2, 1, kRead)}, true);
  m.pass("p2", {use(e, 1, kRead)}, true);
  const Plan plan = m.plan();
  // By size: w0 0..100, s0 100..140, w1 140..179, s1 179..199, w2 199..218.
  EXPECT_EQ(plan.placement.offset[s0], 100u);
  EXPECT_EQ(plan.placement.offset[s1], 179u);
  EXPECT_EQ(plan.placement.offset[e], 179u);
  EXPECT_EQ(plan.placement.bytes_with_aliasing, 218u);
}

// Three that live together, in blocks of 128: none lies across a block's end.
TEST(Place, InBlocksNoneLiesAcrossAnEnd) {
  GraphMaker m;
  const auto a = m.buffer("a", 100), b = m.buffer("b", 60), c = m.buffer("c", 28);
  m.pass("p", {use(a, 0, kWrite), use(b, 0, kWrite), use(c, 0, kWrite)}, true);
  std::vector<MemoryNeed> needs = m.needs(4);
  for (MemoryNeed& need : needs) need.block_bytes = 128;
  const Result<Plan> plan = plan_with(m.graph, needs);
  ASSERT_TRUE(plan.ok());
  EXPECT_EQ(plan->placement.offset[a], 0u);
  EXPECT_EQ(plan->placement.offset[b], 128u);
  EXPECT_EQ(plan->placement.offset[c], 100u);  // the smallest gap: what a left of its block
  EXPECT_THAT(plan->placement.heap_size, testing::ElementsAre(188));
}

TEST(Place, WhatIsLargerThanABlockIsRefusedByName) {
  const GraphMaker m = chain();
  std::vector<MemoryNeed> needs = m.needs();
  for (MemoryNeed& need : needs) need.block_bytes = 100;
  EXPECT_TRUE(plan_with(m.graph, needs).ok());
  needs[0].block_bytes = 99;
  const Result<Plan> plan = plan_with(m.graph, needs);
  ASSERT_FALSE(plan.ok());
  EXPECT_EQ(plan.error().code, ErrorCode::kOutOfMemory);
  EXPECT_EQ(plan.error().message, "a takes 100 bytes, the device gives at most 99 in one piece");
}

TEST(Place, ImportsTakeNoTransientMemory) {
  GraphMaker m;
  const auto a = m.imported_buffer("a");
  m.pass("p", {use(a, 0, kWrite)}, true);
  EXPECT_EQ(m.plan().placement.bytes_without, 0u);
}

}  // namespace
}  // namespace neritic::graph
