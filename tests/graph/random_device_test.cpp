// Random graphs on the device: a pass fills, copies or computes on buffers of odd sizes that share
// memory, while the CPU does the same on plain vectors. Numbers must agree, and synchronization
// validation, which knows nothing of our plans, must stay silent.
#include <algorithm>

#include "engine/core/random.hpp"
#include "executor_fixture.hpp"
#include "graph_maker.hpp"

namespace neritic::graph {
namespace {

using Words = std::vector<std::uint32_t>;

constexpr std::uint32_t kMostBuffers = 10;

class RandomDeviceTest : public ExecutorTest {
 protected:
  struct Known {  // a buffer of the graph and what must be in it
    BufferHandle handle;
    Words words;
  };

  std::uint32_t below(std::uint32_t n) {
    return static_cast<std::uint32_t>(random_bits(key_, index_++) % n);
  }

  struct FillData {
    BufferHandle target;
  };
  void add_fill(FrameGraph& graph, const std::string& name, std::uint32_t count) {
    const std::uint32_t value = below(1u << 30);
    const FillData& data = graph.add_pass<FillData>(
        name,
        [&](PassBuilder& builder, FillData& d) {
          d.target =
              builder.write(builder.create_buffer("b " + name, count * 4u), Access::kTransferWrite);
        },
        [value](const FillData& d, PassContext& context) {
          vkCmdFillBuffer(context.cmd(), context.buffer(d.target).handle(), 0, VK_WHOLE_SIZE,
                          value);
        });
    known_.push_back({data.target, Words(count, value)});
  }

  void add_copy(FrameGraph& graph, const std::string& name, const Known& from, Known& to) {
    const auto count = std::min(from.words.size(), to.words.size());
    const StepData& data = graph.add_pass<StepData>(
        name,
        [&](PassBuilder& builder, StepData& d) {
          d.source = from.handle;
          builder.read(d.source, Access::kTransferRead);
          d.target = builder.write(to.handle, Access::kTransferWrite);
        },
        [count](const StepData& d, PassContext& context) {
          const VkBufferCopy region{0, 0, count * 4};
          vkCmdCopyBuffer(context.cmd(), context.buffer(d.source).handle(),
                          context.buffer(d.target).handle(), 1, &region);
        });
    to.handle = data.target;
    std::copy_n(from.words.begin(), count, to.words.begin());
  }

  void add_compute(FrameGraph& graph, const std::string& name, const Known& from, Known& to) {
    const auto count = static_cast<std::uint32_t>(std::min(from.words.size(), to.words.size()));
    const std::uint32_t factor = below(1000), shift = below(count);
    to.handle = add_step(graph, name, from.handle, factor, shift, to.handle, count);
    const Words result = step({from.words.begin(), from.words.begin() + count}, factor, shift);
    std::copy(result.begin(), result.end(), to.words.begin());
  }

  // Fills known_ with what each buffer holds in the end.
  FrameGraph draw(std::uint64_t seed) {
    key_ = {seed, 3, 0};
    index_ = 0;
    known_.clear();
    FrameGraph graph;
    const std::uint32_t passes = 10 + below(20);
    for (std::uint32_t p = 0; p < passes; ++p) {
      const std::string name = "p" + std::to_string(p);
      if (known_.size() < 2 || (known_.size() < kMostBuffers && below(100) < 30)) {
        add_fill(graph, name, 1 + below(kCount));
        continue;
      }
      // Mostly the newest, so that the old ones die and leave their memory.
      const auto count = static_cast<std::uint32_t>(known_.size());
      const std::uint32_t from = count - 1 - std::min(below(count), below(count));
      const std::uint32_t to = (from + 1 + below(count - 1)) % count;
      below(2) ? add_copy(graph, name, known_[from], known_[to])
               : add_compute(graph, name, known_[from], known_[to]);
    }
    // The newest are asked for; what they do not need is culled.
    for (std::uint32_t i = 0; i < kAsked; ++i) {
      Known& asked = known_[known_.size() - 1 - i];
      Known target{graph.import_buffer("asked " + std::to_string(i), asked_[i]), Words(kCount)};
      add_copy(graph, "ask " + std::to_string(i), asked, target);
      graph.output(target.handle, Access::kHostRead);
    }
    return graph;
  }

  void SetUp() override {
    ExecutorTest::SetUp();
    if (IsSkipped()) return;
    for (gpu::Buffer& buffer : asked_) buffer = make_buffer("asked", gpu::MemoryUse::kReadback);
  }

  static constexpr std::uint32_t kAsked = 2;
  gpu::Buffer asked_[kAsked];
  std::vector<Known> known_;
  RandomKey key_;
  std::uint64_t index_ = 0;
};

TEST_F(RandomDeviceTest, NumbersAreRightAndValidationIsSilent) {
  std::uint32_t shared = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const Plan* plan = run(draw(seed));
    shared += plan->placement.bytes_with_aliasing < plan->placement.bytes_without;
    for (std::uint32_t i = 0; i < kAsked; ++i) {
      const Words& expected = known_[known_.size() - 1 - i].words;
      const auto mapped = asked_[i].mapped<std::uint32_t>();
      ASSERT_TRUE(std::equal(expected.begin(), expected.end(), mapped.begin()))
          << "seed " << seed << "\n"
          << dump_text(*plan);
    }
    ASSERT_THAT(device().validation_log().messages, testing::IsEmpty()) << "seed " << seed;
  }
  EXPECT_GT(shared, 20u);
}

// Debian 12's layer (1.3.239) keeps silent about a shader write after a shader write, to spare
// programs whose shaders write different parts (its SuppressedBoundDescriptorWAW, gone since 2026).
// The simulator does see them.
bool between_shader_writes(const Barrier& barrier) {
  constexpr VkAccessFlags2 kWrite = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
  return (barrier.src_access & kWrite) != 0 && (barrier.dst_access & kWrite) != 0;
}

TEST_F(RandomDeviceTest, EveryPlantedMissingBarrierIsCaught) {
  // All barriers of some graphs, one dropped at a time.
  std::size_t dropped = 0;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const FrameGraph graph = draw(seed);
    const Plan plan = *take(executor_->compile(graph));
    for (std::size_t position = 0; position < plan.order.size(); ++position) {
      for (const Barrier& barrier : barriers_at(plan, position)) {
        // An earlier frame's accesses are in another submission, which the layer does not see.
        if (plan.graph.resources[barrier.resource].imported) continue;
        if (between_shader_writes(barrier)) continue;
        const auto drop = [&](Plan& spoilt) {
          const auto same = [&](const Barrier& b) { return b.resource == barrier.resource; };
          std::erase_if(spoilt.barriers.first[position], same);
          std::erase_if(spoilt.barriers.before[position], same);
        };
        ++dropped;
        EXPECT_THAT(validation_after(drop, graph),
                    testing::Contains(testing::HasSubstr("SYNC-HAZARD")))
            << "seed " << seed << ", barrier on resource " << barrier.resource << " before "
            << position << "\n"
            << dump_text(plan);
      }
    }
  }
  EXPECT_GT(dropped, 30u);
}

}  // namespace
}  // namespace neritic::graph
