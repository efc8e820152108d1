// Runs in a row: what a run waits for of those before it, exactly, and by the simulator over random
// runs that share memory and objects.
#include "engine/graph/past.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <tuple>

#include "random_graph.hpp"
#include "simulator.hpp"

namespace neritic::graph {
namespace {

using testing::IsEmpty;
using testing::SizeIs;

constexpr auto kShader = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
constexpr auto kCopy = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
constexpr std::uint64_t kHeaps[] = {0, 1, 2, 3};

// [make] -> (a1) -> [bring] -> (b1) -> host, b is imported
GraphMaker picture_to_host() {
  GraphMaker m;
  const auto a = m.buffer("a"), b = m.imported_buffer("b");
  m.pass("make", {use(a, 0, kWrite)});
  m.pass("bring", {use(a, 1, Access::kTransferRead), use(b, 0, Access::kTransferWrite)});
  m.output(b, 1, Access::kHostRead);
  return m;
}

TEST(Past, ARunWaitsForTheSameBytesAndObjectsOnly) {
  Plan plan = picture_to_host().plan();
  const std::uint64_t objects[] = {0, 7}, others[] = {0, 8};
  Past past;
  past.run(plan, objects, kHeaps, plan.barriers.first);
  for (const auto& list : plan.barriers.first) EXPECT_THAT(list, IsEmpty());

  past.run(plan, objects, kHeaps, plan.barriers.first);
  ASSERT_THAT(plan.barriers.first[0], SizeIs(1));  // a's bytes: the copy read them
  const Barrier& memory = plan.barriers.first[0][0];
  EXPECT_EQ(memory.src_stages, kCopy);
  EXPECT_EQ(memory.src_access, 0u);
  EXPECT_EQ(memory.dst_stages, kShader);
  EXPECT_TRUE(memory.earlier);
  ASSERT_THAT(plan.barriers.first[1], SizeIs(1));  // b: made ready for the host before
  EXPECT_EQ(plan.barriers.first[1][0].src_stages, VK_PIPELINE_STAGE_2_HOST_BIT);
  EXPECT_EQ(plan.barriers.first[1][0].dst_stages, kCopy);

  past.run(plan, others, kHeaps, plan.barriers.first);  // another b
  EXPECT_THAT(plan.barriers.first[0], SizeIs(1));
  EXPECT_THAT(plan.barriers.first[1], IsEmpty());

  past.forget_memory();
  past.run(plan, others, kHeaps, plan.barriers.first);
  EXPECT_THAT(plan.barriers.first[0], IsEmpty());
  EXPECT_THAT(plan.barriers.first[1], SizeIs(1));
}

TEST(Past, BytesThatNoEarlierRunHadNeedNoWait) {
  GraphMaker small, large;
  const auto a = small.buffer("a", 100);
  small.pass("P", {use(a, 0, kWrite)}, true);
  const auto b = large.buffer("b", 100), c = large.buffer("c", 90);
  large.pass("P", {use(b, 0, kWrite), use(c, 0, kWrite)}, true);
  Plan first = small.plan(), second = large.plan();
  ASSERT_EQ(second.placement.offset[c], 100u);
  Past past;
  past.run(first, {}, kHeaps, first.barriers.first);
  past.run(second, {}, kHeaps, second.barriers.first);
  ASSERT_THAT(second.barriers.first[0], SizeIs(1));
  EXPECT_EQ(second.barriers.first[0][0].resource, b);
}

TEST(Past, ReadersOfAnImportNeverWaitForReaders) {
  GraphMaker compute, fragment, writer;
  for (GraphMaker* m : {&compute, &fragment, &writer}) m->imported_buffer("table");
  compute.pass("P", {use(0, 0, kRead)}, true);
  fragment.pass("P", {use(0, 0, Access::kStorageReadFragment)}, true);
  writer.pass("P", {use(0, 0, Access::kTransferWrite)}, true);
  Plan reads = compute.plan(), draws = fragment.plan(), writes = writer.plan();
  const std::uint64_t objects[] = {5};
  Past past;
  past.run(writes, objects, {}, writes.barriers.first);
  past.run(reads, objects, {}, reads.barriers.first);
  EXPECT_THAT(reads.barriers.first[0], SizeIs(1));  // after the write
  past.run(draws, objects, {}, draws.barriers.first);
  EXPECT_THAT(draws.barriers.first[0], SizeIs(1));  // the write, at another stage
  for (int i = 0; i < 3; ++i) {
    past.run(reads, objects, {}, reads.barriers.first);
    EXPECT_THAT(reads.barriers.first[0], IsEmpty());
    past.run(draws, objects, {}, draws.barriers.first);
    EXPECT_THAT(draws.barriers.first[0], IsEmpty());
  }
  past.run(writes, objects, {}, writes.barriers.first);
  ASSERT_THAT(writes.barriers.first[0], SizeIs(1));  // after both
  EXPECT_EQ(writes.barriers.first[0][0].src_stages,
            kShader | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT);
}

TEST(Past, SettledNothingIsPending) {
  Plan plan = picture_to_host().plan();
  const std::uint64_t objects[] = {0, 7};
  Past past;
  past.run(plan, objects, kHeaps, plan.barriers.first);
  EXPECT_EQ(past.object_count(), 1u);
  past.settle();
  EXPECT_EQ(past.object_count(), 0u);
  past.run(plan, objects, kHeaps, plan.barriers.first);
  for (const auto& list : plan.barriers.first) EXPECT_THAT(list, IsEmpty());
}

// --- Random runs

constexpr std::uint64_t kSequences = 300;

// Imports of one shape are one object, in all graphs of a sequence.
class Sequence {
 public:
  explicit Sequence(std::uint64_t seed) {
    for (const std::uint64_t s : {2 * seed, 2 * seed + 1}) {
      RandomGraph random = random_graph(s);
      // Presentation waits by semaphores, which are not part of a plan.
      std::erase_if(random.maker.graph.outputs,
                    [](const Use& u) { return u.access == Access::kPresent; });
      Result<Plan> plan = plan_with(random.maker.graph, random.needs);
      EXPECT_TRUE(plan.ok());
      plans_.push_back(std::move(plan).value());
    }
    for (const std::size_t which : {0, 0, 1, 0, 1, 1}) add(which);
  }
  std::vector<PlanRun> runs;

 private:
  void add(std::size_t which) {
    PlanRun run{plans_[which], {}, {0, 1, 2, 3}};
    std::map<std::tuple<bool, std::uint32_t, std::uint32_t>, std::uint64_t> count;
    for (ResourceDecl& r : run.plan.graph.resources) {
      const bool image = r.kind == ResourceKind::kImage;
      std::uint64_t id = 0;
      if (r.imported) {
        id = (image ? 100 : 200) + 1000 * r.mips + 10000 * r.layers +
             ++count[{image, r.mips, r.layers}];
        // Without contents nobody else can read it.
        if (image && r.initial_layout == VK_IMAGE_LAYOUT_UNDEFINED) id += 100000 * (which + 1);
        begin(r, id);
      }
      run.objects.push_back(id);
    }
    past_.run(run.plan, run.objects, run.classes, run.plan.barriers.first);
    runs.push_back(std::move(run));
  }

  // Known from the first run on, with what its first graph says of it; then the past knows.
  void begin(ResourceDecl& r, std::uint64_t id) {
    r.history = History::kLast;  // its layout is the past's to know
    if (past_.object(id).empty()) {
      const bool write = (r.initial_access & kWriteAccess) != 0;
      past_.set_object(
          id, Past::State(std::size_t{r.mips} * r.layers,
                          {{0, r.initial_stages, r.initial_access, r.initial_layout, write},
                           r.initial_stages == 0}));
    } else {
      r.initial_stages = r.initial_access = 0;
    }
  }

  std::vector<Plan> plans_;
  Past past_;
};

TEST(RandomRuns, HaveNoHazardInAnyByteOrObject) {
  std::size_t earlier = 0;
  for (std::uint64_t seed = 0; seed < kSequences; ++seed) {
    const Sequence sequence(seed);
    const auto hazards = find_hazards(sequence.runs);
    std::string text;
    if (!hazards.empty())
      for (const PlanRun& run : sequence.runs) text += dump_text(run.plan);
    ASSERT_TRUE(hazards.empty()) << "seed " << seed << ": " << hazards.front() << "\n" << text;
    for (const PlanRun& run : sequence.runs)
      for (const auto& list : run.plan.barriers.first)
        for (const Barrier& barrier : list) earlier += barrier.earlier;
  }
  EXPECT_GT(earlier, 10 * kSequences);
}

TEST(RandomRuns, NeedEveryBarrierAfterAnEarlierRun) {
  std::size_t dropped = 0;
  for (std::uint64_t seed = 0; seed < kSequences / 8; ++seed) {
    Sequence sequence(seed);
    for (PlanRun& run : sequence.runs)
      for (auto& list : run.plan.barriers.first)
        for (std::size_t i = 0; i < list.size(); ++i) {
          if (!list[i].earlier) continue;
          const std::vector<Barrier> whole = list;
          list.erase(list.begin() + static_cast<std::ptrdiff_t>(i));
          ++dropped;
          ASSERT_FALSE(find_hazards(sequence.runs).empty())
              << "seed " << seed << ": nobody misses the barrier on "
              << run.plan.graph.resources[whole[i].resource].name << " of run "
              << &run - sequence.runs.data() << "\n"
              << dump_text(run.plan);
          list = whole;
        }
  }
  EXPECT_GT(dropped, kSequences);
}

}  // namespace
}  // namespace neritic::graph
