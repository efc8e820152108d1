// Properties of every plan, on random graphs: no hazard that the simulator can find, no barrier
// that could go, no memory shared while both live.
#include "random_graph.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "engine/graph/access.hpp"
#include "simulator.hpp"
#include "tests/support/support.hpp"

namespace neritic::graph {
namespace {

const std::uint64_t kGraphs = test::is_thorough() ? 4000 : 1000;

Plan plan_of(const RandomGraph& random) {
  Result<Plan> plan = plan_with(random.maker.graph, random.needs);
  EXPECT_TRUE(plan.ok()) << (plan.ok() ? "" : plan.error().message);
  return std::move(plan).value();
}

TEST(RandomGraphs, HaveNoHazardInAnyByte) {
  std::size_t passes = 0, barriers = 0;
  for (std::uint64_t seed = 0; seed < kGraphs; ++seed) {
    const Plan plan = plan_of(random_graph(seed));
    const auto hazards = find_hazards(plan);
    ASSERT_TRUE(hazards.empty()) << "seed " << seed << ": " << hazards.front() << "\n"
                                 << dump_text(plan);
    passes += plan.order.size();
    for (std::size_t p = 0; p <= plan.order.size(); ++p) barriers += barriers_at(plan, p).size();
  }
  // The graphs are worth the walk.
  EXPECT_GT(passes, 3 * kGraphs);
  EXPECT_GT(barriers, 5 * kGraphs);
}

// Every barrier of a plan, so that each can be spoilt in turn.
std::vector<Barrier*> all_barriers(Plan& plan) {
  std::vector<Barrier*> all;
  for (auto* lists : {&plan.barriers.first, &plan.barriers.before})
    for (auto& list : *lists)
      for (Barrier& barrier : list) all.push_back(&barrier);
  return all;
}

TEST(RandomGraphs, NeedEveryBarrierTheyHave) {
  std::size_t dropped = 0;
  for (std::uint64_t seed = 0; seed < kGraphs / 4; ++seed) {
    const Plan plan = plan_of(random_graph(seed));
    for (std::size_t position = 0; position <= plan.order.size(); ++position)
      for (auto lists : {&BarrierPlan::first, &BarrierPlan::before})
        for (std::size_t i = 0; i < (plan.barriers.*lists)[position].size(); ++i) {
          Plan spoilt = plan;
          auto& target = (spoilt.barriers.*lists)[position];
          target.erase(target.begin() + static_cast<std::ptrdiff_t>(i));
          ++dropped;
          ASSERT_FALSE(find_hazards(spoilt).empty())
              << "seed " << seed << ": nobody misses barrier " << i << " before " << position
              << "\n"
              << dump_text(plan);
        }
  }
  EXPECT_GT(dropped, kGraphs);
}

// The planted fault: one bit of one barrier of a plan.
struct Cut {
  const Plan& plan;
  const Barrier& barrier;
  std::uint64_t bit;
  bool imported() const { return plan.graph.resources[barrier.resource].imported; }
};

// Takes each bit out of the mask of each barrier, one at a time; says which cuts nobody missed.
// expected: the cuts that rightly go unnoticed.
template <class Mask>
void every_bit_is_missed(Mask mask, const std::function<bool(const Cut&)>& expected) {
  std::size_t tried = 0;
  for (std::uint64_t seed = 0; seed < kGraphs / 8; ++seed) {
    Plan spoilt = plan_of(random_graph(seed));
    for (Barrier* barrier : all_barriers(spoilt)) {
      const Barrier whole = *barrier;
      for (std::uint64_t left = whole.*mask; left; left &= left - 1) {
        const Cut cut{spoilt, whole, left & ~(left - 1)};
        // A first use waits for every earlier owner of its memory, though the last would do
        // (barriers.cpp).
        if (whole.discards || expected(cut)) continue;
        barrier->*mask = whole.*mask & ~cut.bit;
        ++tried;
        EXPECT_FALSE(find_hazards(spoilt).empty())
            << "seed " << seed << ", bit " << std::hex << cut.bit << ", barrier on "
            << spoilt.graph.resources[whole.resource].name << "\n"
            << dump_text(spoilt);
        *barrier = whole;
      }
    }
  }
  EXPECT_GT(tried, kGraphs / 2);
}

TEST(RandomGraphs, NeedEveryStageTheyWaitFor) {
  every_bit_is_missed(&Barrier::src_stages, [](const Cut&) { return false; });
}

TEST(RandomGraphs, NeedEveryStageTheyServe) {
  // An import that was read in the same layout before is visible at those stages already.
  every_bit_is_missed(&Barrier::dst_stages, [](const Cut& cut) {
    return cut.imported() && cut.barrier.src_access == 0 &&
           cut.barrier.old_layout == cut.barrier.new_layout &&
           (cut.barrier.src_stages & cut.bit) != 0;
  });
}

TEST(RandomGraphs, NeedEveryAccessTheyMakeAvailable) {
  every_bit_is_missed(&Barrier::src_access, [](const Cut&) { return false; });
}

TEST(RandomGraphs, NeedEveryAccessTheyMakeVisible) {
  // After reads (src_access 0) in one layout, what the reads saw is visible to such reads already.
  every_bit_is_missed(&Barrier::dst_access, [](const Cut& cut) {
    constexpr VkAccessFlags2 kWrites =
        VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT |
        VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT;
    if (cut.barrier.src_access != 0 || cut.barrier.discards) return false;
    if (cut.barrier.old_layout != cut.barrier.new_layout) return false;
    // An import with nothing pending: there is no write to see.
    const ResourceDecl& resource = cut.plan.graph.resources[cut.barrier.resource];
    return (cut.bit & kWrites) == 0 || (resource.imported && resource.initial_stages == 0);
  });
}

TEST(RandomGraphs, ResourcesThatLiveTogetherNeverShareMemory) {
  std::size_t shared = 0;
  for (std::uint64_t seed = 0; seed < kGraphs; ++seed) {
    const Plan plan = plan_of(random_graph(seed));
    const auto count = static_cast<std::uint32_t>(plan.graph.resources.size());
    for (std::uint32_t a = 0; a < count; ++a) {
      if (plan.graph.resources[a].imported || !plan.lifetimes[a].used()) continue;
      const std::uint64_t a0 = plan.placement.offset[a], a1 = a0 + plan.needs[a].size;
      ASSERT_EQ(a0 % plan.needs[a].alignment, 0u);
      ASSERT_LE(a1, plan.placement.heap_size[plan.needs[a].memory_class]);
      for (std::uint32_t b = a + 1; b < count; ++b) {
        if (plan.graph.resources[b].imported || !plan.lifetimes[b].used()) continue;
        if (plan.needs[a].memory_class != plan.needs[b].memory_class) continue;
        const std::uint64_t b0 = plan.placement.offset[b], b1 = b0 + plan.needs[b].size;
        if (a1 <= b0 || b1 <= a0) continue;
        ++shared;
        ASSERT_TRUE(plan.lifetimes[a].last < plan.lifetimes[b].first ||
                    plan.lifetimes[b].last < plan.lifetimes[a].first)
            << "seed " << seed;
      }
    }
    ASSERT_LE(plan.placement.bytes_with_aliasing, plan.placement.bytes_without);
  }
  EXPECT_GT(shared, kGraphs / 4);  // they do share
}

TEST(RandomGraphs, KeepAReaderOrOutputForEveryPass) {
  // A pass is kept if and only if dropping it breaks something: each kept pass has a side effect,
  // or changes a part that an output or a kept pass uses later.
  for (std::uint64_t seed = 0; seed < kGraphs; ++seed) {
    const GraphDecl graph = random_graph(seed).maker.graph;
    const std::vector<bool> kept = cull(graph);
    for (std::size_t p = 0; p < graph.passes.size(); ++p) {
      bool needed = graph.passes[p].side_effect;
      for (const Use& made : graph.passes[p].uses) {
        if (!access_info(made.access).write) continue;
        const auto uses_it = [&](const Use& u) {
          return u.version > made.version && uses_meet(graph, u, made);
        };
        for (const Use& output : graph.outputs) needed |= uses_it(output);
        for (std::size_t q = 0; q < graph.passes.size(); ++q)
          for (const Use& u : graph.passes[q].uses) needed |= kept[q] && uses_it(u);
      }
      ASSERT_EQ(kept[p], needed) << "seed " << seed << " pass " << p;
    }
  }
}

}  // namespace
}  // namespace neritic::graph
