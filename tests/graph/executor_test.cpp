// The executor on a real device: right numbers in shared memory, nothing allocated in equal frames.
#include <fmt/format.h>

#include <chrono>

#include "engine/graph/realisation.hpp"
#include "engine/graph/transient_heaps.hpp"
#include "executor_fixture.hpp"
#include "graph_maker.hpp"

namespace neritic::graph {
namespace {

using testing::HasSubstr;

TEST_F(ExecutorTest, ChainInSharedMemoryGivesTheRightNumbers) {
  const Plan* plan = run(chain());
  const std::uint32_t a = find_resource(*plan, "of one"), b = find_resource(*plan, "of two"),
                      c = find_resource(*plan, "of three");
  EXPECT_EQ(plan->placement.offset[a], plan->placement.offset[c]);
  EXPECT_NE(plan->placement.offset[a], plan->placement.offset[b]);
  EXPECT_EQ(answers(), chain_result());
}

TEST_F(ExecutorTest, EqualFramesAllocateNothingAndPlanOnce) {
  const Plan* first = run(chain());
  const std::uint64_t bytes = executor_->transient_bytes();
  const std::uint32_t allocations = device().allocator().statistics().allocations;
  EXPECT_GE(bytes, first->placement.bytes_with_aliasing);
  EXPECT_GT(bytes, 0u);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(run(chain()), first);
  EXPECT_EQ(executor_->transient_bytes(), bytes);
  EXPECT_EQ(device().allocator().statistics().allocations, allocations);
  EXPECT_EQ(answers(), chain_result());
}

TEST_F(ExecutorTest, FramesInFlightDoNotDisturbEachOther) {
  // Both frames use the same transient memory; the second is recorded while the first runs.
  std::uint64_t value = 0;
  for (int i = 0; i < 6; ++i) {
    FrameGraph graph = chain();
    gpu::Commands* commands = take(frames_->begin());
    take(executor_->run(graph, *commands));
    value = take(frames_->submit());
  }
  ASSERT_TRUE(frames_->wait(value).ok());
  EXPECT_EQ(answers(), chain_result());
}

TEST_F(ExecutorTest, ImportsMayMoveBetweenEqualDeclarations) {
  const Plan* first = run(chain());
  answers_ = make_buffer("answers", gpu::MemoryUse::kReadback);
  EXPECT_EQ(run(chain()), first);
  EXPECT_EQ(answers(), chain_result());
}

TEST_F(ExecutorTest, OldGraphsGiveTheirMemoryBack) {
  std::uint64_t after_few = 0;
  for (std::uint32_t i = 0; i < 40; ++i) {
    FrameGraph graph;
    const BufferHandle input = graph.import_buffer("input", input_, ImportState{0, 0});
    const BufferHandle target = add_step(graph, "variant " + std::to_string(i), input, i, 1);
    graph.output(add_step(graph, "last", target, 1, 2, graph.import_buffer("answers", answers_)),
                 Access::kHostRead);
    run(std::move(graph));
    if (i == 7) after_few = executor_->transient_bytes();
  }
  EXPECT_GT(after_few, 0u);
  EXPECT_EQ(executor_->transient_bytes(), after_few);
  const auto input = input_.mapped<std::uint32_t>();
  EXPECT_EQ(answers(), step(step({input.begin(), input.begin() + kCount}, 39, 1), 1, 2));
}

// Twelve graphs of different sizes, frames in flight: what sensors at rates of their own declare.
TEST_F(ExecutorTest, GraphsThatTakeTurnsShareTheMemoryOfTheLargest) {
  const auto graph_of = [&](std::uint32_t i) {
    FrameGraph graph;
    const BufferHandle input = graph.import_buffer("input", input_, ImportState{0, 0});
    const std::string number = std::to_string(i);
    const std::uint32_t room = kCount * (1 + (i * 5) % 12);
    const BufferHandle a = add_step(graph, "a" + number, input, i + 2, 1, {}, kCount, room);
    const BufferHandle b = add_step(graph, "b" + number, a, 3, 2, {}, kCount, room);
    graph.output(add_step(graph, "last", b, 1, 3, graph.import_buffer("answers", answers_)),
                 Access::kHostRead);
    return graph;
  };
  const auto input = input_.mapped<std::uint32_t>();
  const std::vector<std::uint32_t> source(input.begin(), input.begin() + kCount);
  std::uint64_t largest = 0;
  for (std::uint32_t i = 0; i < 12; ++i) {
    const Plan* plan = run(graph_of(i));
    largest = std::max(largest, plan->placement.bytes_with_aliasing);
    EXPECT_EQ(answers(), step(step(step(source, i + 2, 1), 3, 2), 1, 3)) << i;
  }
  EXPECT_EQ(executor_->transient_bytes(), largest);
  const std::uint32_t allocations = device().allocator().statistics().allocations;
  std::uint64_t value = 0;
  for (std::uint32_t frame = 0; frame < 36; ++frame) {
    FrameGraph graph = graph_of(frame * 7 % 12);
    gpu::Commands* commands = take(frames_->begin());
    take(executor_->run(graph, *commands));
    value = take(frames_->submit());
  }
  ASSERT_TRUE(frames_->wait(value).ok());
  EXPECT_EQ(answers(), step(step(step(source, 35 * 7 % 12 + 2, 1), 3, 2), 1, 3));
  EXPECT_EQ(executor_->transient_bytes(), largest);
  EXPECT_EQ(device().allocator().statistics().allocations, allocations);
}

TEST_F(ExecutorTest, AGraphThatRunsNoMoreGivesItsMemoryBack) {
  run(chain());
  const std::uint64_t small = executor_->transient_bytes();
  FrameGraph large;
  const BufferHandle input = large.import_buffer("input", input_, ImportState{0, 0});
  large.output(
      add_step(large, "last", add_step(large, "large", input, 1, 1, {}, kCount, 100 * kCount), 1, 2,
               large.import_buffer("answers", answers_)),
      Access::kHostRead);
  run(std::move(large));
  const std::uint64_t both = executor_->transient_bytes();
  EXPECT_GE(both, 100 * kCount * sizeof(std::uint32_t));
  for (int i = 0; i < 10; ++i) run(chain());
  EXPECT_EQ(executor_->transient_bytes(), both);
  for (int i = 0; i < 300; ++i) run(chain());
  EXPECT_EQ(executor_->transient_bytes(), small);
  EXPECT_EQ(answers(), chain_result());
}

TEST_F(ExecutorTest, CulledPassesAreNotRecorded) {
  FrameGraph graph = chain();
  bool ran = false;
  struct Nothing {
    BufferHandle buffer;
  };
  graph.add_pass<Nothing>(
      "unwanted",
      [](PassBuilder& builder, Nothing& data) {
        data.buffer =
            builder.write(builder.create_buffer("waste", 1 << 20), Access::kStorageWriteCompute);
      },
      [&ran](const Nothing&, PassContext&) { ran = true; });
  const Plan* plan = run(std::move(graph));
  EXPECT_FALSE(ran);
  EXPECT_EQ(plan->order.size(), 4u);
  EXPECT_LT(executor_->transient_bytes(), 1u << 20);
}

TEST_F(ExecutorTest, AGraphOfWhichNothingIsWantedRunsWithoutMemory) {
  FrameGraph graph;
  struct Nothing {
    ImageHandle image;
  };
  graph.add_pass<Nothing>(
      "unwanted",
      [](PassBuilder& builder, Nothing& data) {
        data.image =
            builder.write(builder.create_image("waste", {VK_FORMAT_R8G8B8A8_UNORM, 16, 16, 1}),
                          Access::kStorageWriteCompute);
      },
      [](const Nothing&, PassContext&) {});
  const Plan* plan = run(std::move(graph));
  EXPECT_TRUE(plan->order.empty());
  EXPECT_EQ(executor_->transient_bytes(), 0u);
}

TEST_F(ExecutorTest, WrongGraphIsAnErrorThatNamesPassAndResource) {
  FrameGraph graph;
  const BufferHandle input = graph.import_buffer("input", input_);
  const BufferHandle a = add_step(graph, "one", input, 3, 1);
  graph.output(add_step(graph, "two", a, 5, 1, a), Access::kHostRead);  // reads what it writes over
  const Result<const Plan*> fine = executor_->compile(graph);
  EXPECT_TRUE(fine.ok());  // a storage write includes the read
  add_step(graph, "late", a, 1, 1);
  const Result<const Plan*> plan = executor_->compile(graph);
  ASSERT_FALSE(plan.ok());
  EXPECT_THAT(plan.error().message, HasSubstr("pass \"late\" reads version 1 of \"of one\""));
}

// Its numbers may well exist in the next frame's graph, where they mean something else.
TEST_F(ExecutorTest, AHandleKeptFromAnotherFramesGraphStopsTheProgram) {
  FrameGraph earlier, now;
  const BufferHandle stale = earlier.import_buffer("input", input_);
  const BufferHandle fresh = now.import_buffer("input", input_);
  ASSERT_EQ(stale.resource, fresh.resource);
  EXPECT_DEATH(add_step(now, "one", stale, 3, 1), "pass one .*kept from an earlier frame");
  EXPECT_DEATH(now.output(stale, Access::kHostRead), "an output .*kept from an earlier frame");
}

// Each buffer in a block of its own.
TEST_F(ExecutorTest, MemoryInBlocksHoldsWhatThePlanPlacedThere) {
  GraphDecl graph = chain().declaration();
  gather_usage(graph);
  std::vector<MemoryClass> classes;
  std::vector<MemoryNeed> needs = memory_needs(device(), graph, classes);
  ASSERT_EQ(classes.size(), 1u);
  classes[0].block_bytes = 4096;  // a buffer is of 4000 bytes
  for (MemoryNeed& need : needs) need.block_bytes = 4096;
  const Plan plan = take(plan_with(graph, needs));
  ASSERT_GT(plan.placement.heap_size[0], 4096u);  // two live at the same time
  std::vector<TransientHeaps::Need> heap_needs;
  TransientHeaps::add(heap_needs, classes[0], plan.placement.heap_size[0]);
  TransientHeaps heaps;
  ASSERT_TRUE(heaps.allocate(device().allocator(), heap_needs).ok());
  const TransientHeaps::Place first = heaps.at(classes[0], 0), last = heaps.at(classes[0], 4095),
                              next = heaps.at(classes[0], 4096);
  EXPECT_EQ(last.memory, first.memory);
  EXPECT_EQ(last.offset, first.offset + 4095);
  EXPECT_TRUE(next.memory != first.memory || next.offset >= first.offset + 4096 ||
              next.offset + 4000 <= first.offset);
  const Realisation made = take(Realisation::create(device(), plan, classes, heaps));
  for (std::size_t r = 0; r < plan.graph.resources.size(); ++r)
    if (!plan.graph.resources[r].imported) {
      EXPECT_TRUE(made.buffers()[r]) << plan.graph.resources[r].name;
    }
}

TEST_F(ExecutorTest, PassesAreTimedByName) {
  run(chain());
  run(chain());
  run(chain());
  std::vector<std::string> names;
  for (const gpu::PassTime& time : frames_->pass_times()) names.push_back(time.name);
  if (names.empty()) GTEST_SKIP() << "this queue has no timestamps";
  EXPECT_THAT(names, testing::IsSupersetOf({"one", "two", "three", "four"}));
}

}  // namespace
}  // namespace neritic::graph
