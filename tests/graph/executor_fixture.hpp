// A device with validation and synchronization validation, an executor, and a small graph of
// compute passes to run on it. Every test fails on any validation message that it did not plant.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/gpu/device.hpp"
#include "engine/graph/frame_graph.hpp"
#include "shaders.hpp"
#include "tests/support/gpu_fixture.hpp"

namespace neritic::graph {

inline constexpr std::uint32_t kCount = 1000;  // deliberately no multiple of the group size

struct Push {
  std::uint32_t count, factor, shift;
};

// The result of test_graph_step.comp.
inline std::vector<std::uint32_t> step(const std::vector<std::uint32_t>& source,
                                       std::uint32_t factor, std::uint32_t shift) {
  std::vector<std::uint32_t> target(source.size());
  for (std::size_t i = 0; i < source.size(); ++i)
    target[i] = source[i] * factor + source[(i + shift) % source.size()];
  return target;
}

class ExecutorTest : public test::GpuTest {
 protected:
  void SetUp() override {
    GpuTest::SetUp();
    if (IsSkipped()) return;
    frames_ = take(gpu::Frames::create(device()));
    executor_ = std::make_unique<Executor>(*frames_);
    gpu::ComputePipelineDesc desc;
    desc.name = "step";
    desc.code = shaders::kTestGraphStepComp;
    desc.layout.bindings = {{0}, {1}};
    desc.layout.push_constant_bytes = sizeof(Push);
    step_ = take(gpu::Pipeline::create(device(), desc));
    desc.name = "sum";
    desc.code = shaders::kTestGraphSumComp;
    desc.layout.bindings = {{0, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE}, {1}};
    desc.layout.push_constant_bytes = sizeof(std::uint32_t);
    sum_ = take(gpu::Pipeline::create(device(), desc));
    input_ = make_buffer("input", gpu::MemoryUse::kUpload);
    answers_ = make_buffer("answers", gpu::MemoryUse::kReadback);
    const std::span<std::uint32_t> input = input_.mapped<std::uint32_t>();
    for (std::uint32_t i = 0; i < kCount; ++i) input[i] = i * 2654435761u;
  }

  template <class T>
  static T take(Result<T> result) {
    EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().message);
    return std::move(result).value();
  }

  gpu::Buffer make_buffer(const std::string& name, gpu::MemoryUse memory) {
    return take(gpu::Buffer::create(
        device(), {name, kCount * sizeof(std::uint32_t),
                   VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT, memory}));
  }

  struct StepData {
    BufferHandle source, target;
  };
  // One more pass of test_graph_step.comp; target: where to, a new transient, with room for this
  // many numbers, where it is none.
  BufferHandle add_step(FrameGraph& graph, const std::string& name, BufferHandle source,
                        std::uint32_t factor, std::uint32_t shift, BufferHandle target = {},
                        std::uint32_t count = kCount, std::uint32_t room = kCount) {
    return graph
        .add_pass<StepData>(
            name,
            [&](PassBuilder& builder, StepData& data) {
              data.source = source;
              builder.read(source, Access::kStorageReadCompute);
              if (!target)
                target = builder.create_buffer("of " + name, room * sizeof(std::uint32_t));
              data.target = builder.write(target, Access::kStorageWriteCompute);
            },
            [this, factor, shift, count](const StepData& data, PassContext& context) {
              gpu::Commands& commands = context.commands;
              commands.bind_pipeline(step_);
              commands.bind(step_, {gpu::bound_buffer(0, context.buffer(data.source).handle()),
                                    gpu::bound_buffer(1, context.buffer(data.target).handle())});
              commands.push(step_, Push{count, factor, shift});
              commands.dispatch((count + 63) / 64);
            })
        .target;
  }

  // input -> [one] -> (a) -> [two] -> (b) -> [three] -> (c, in a's memory) -> [four] -> answers
  FrameGraph chain() {
    FrameGraph graph;
    const BufferHandle input = graph.import_buffer("input", input_, ImportState{0, 0});
    const BufferHandle answers = graph.import_buffer("answers", answers_);
    const BufferHandle a = add_step(graph, "one", input, 3, 1);
    const BufferHandle b = add_step(graph, "two", a, 5, 500);
    const BufferHandle c = add_step(graph, "three", b, 7, 900);
    graph.output(add_step(graph, "four", c, 11, 17, answers), Access::kHostRead);
    return graph;
  }
  std::vector<std::uint32_t> chain_result() const {
    const auto input = input_.mapped<std::uint32_t>();
    const std::vector<std::uint32_t> source(input.begin(), input.begin() + kCount);
    return step(step(step(step(source, 3, 1), 5, 500), 7, 900), 11, 17);
  }
  std::vector<std::uint32_t> answers() const {
    const auto mapped = answers_.mapped<std::uint32_t>();
    return {mapped.begin(), mapped.begin() + kCount};
  }

  // One whole frame of the graph; the plan that ran.
  const Plan* run(FrameGraph graph) {
    gpu::Commands* commands = take(frames_->begin());
    const Plan* plan = take(executor_->run(graph, *commands));
    const std::uint64_t value = take(frames_->submit());
    EXPECT_TRUE(frames_->wait(value).ok());
    return plan;
  }

  // Drops or changes barriers on a resource, runs, and returns what validation said about it.
  std::vector<std::string> validation_after(const std::function<void(Plan&)>& spoil,
                                            FrameGraph graph) {
    EXPECT_THAT(device().validation_log().messages, testing::IsEmpty());
    executor_->spoil_plans_for_test(spoil);
    run(std::move(graph));
    executor_->spoil_plans_for_test({});
    std::vector<std::string> messages = device().validation_log().messages;
    device().clear_validation_log();
    return messages;
  }

  std::unique_ptr<gpu::Frames> frames_;
  std::unique_ptr<Executor> executor_;
  gpu::Pipeline step_, sum_;
  gpu::Buffer input_, answers_;
};

inline std::uint32_t find_resource(const Plan& plan, const std::string& name) {
  for (std::uint32_t r = 0; r < plan.graph.resources.size(); ++r)
    if (plan.graph.resources[r].name == name) return r;
  ADD_FAILURE() << "no resource " << name;
  return 0;
}

// Removes every barrier on the resource before that position.
inline std::function<void(Plan&)> drop_barriers(const std::string& name, std::size_t position) {
  return [name, position](Plan& plan) {
    const std::uint32_t r = find_resource(plan, name);
    const auto on_it = [r](const Barrier& b) { return b.resource == r; };
    EXPECT_GT(std::erase_if(plan.barriers.first[position], on_it) +
                  std::erase_if(plan.barriers.before[position], on_it),
              0u);
  };
}

}  // namespace neritic::graph
