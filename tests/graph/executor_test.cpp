// The executor on a real device, with validation and synchronization validation: right numbers, no
// message; and a planted wrong barrier is caught.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "engine/gpu/device.hpp"
#include "engine/graph/frame_graph.hpp"
#include "shaders.hpp"

namespace neritic::graph {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr std::uint32_t kCount = 1000;  // deliberately no multiple of the group size

struct Push {
  std::uint32_t count, factor, shift;
};

// What test_graph_step.comp computes.
std::vector<std::uint32_t> step(const std::vector<std::uint32_t>& source, std::uint32_t factor,
                                std::uint32_t shift) {
  std::vector<std::uint32_t> target(source.size());
  for (std::size_t i = 0; i < source.size(); ++i)
    target[i] = source[i] * factor + source[(i + shift) % source.size()];
  return target;
}

class ExecutorTest : public testing::Test {
 protected:
  void SetUp() override {
    gpu::DeviceOptions options;
    options.validation = true;
    Result<std::unique_ptr<gpu::Device>> device = gpu::Device::create(options);
    if (!device) {
      ASSERT_EQ(device.error().code, ErrorCode::kNoDevice) << device.error().message;
      GTEST_SKIP() << device.error().message;
    }
    device_ = std::move(device).value();
    frames_ = take(gpu::Frames::create(*device_));
    executor_ = std::make_unique<Executor>(*frames_);
    gpu::ComputePipelineDesc desc;
    desc.name = "step";
    desc.code = shaders::kTestGraphStepComp;
    desc.layout.bindings = {{0}, {1}};
    desc.layout.push_constant_bytes = sizeof(Push);
    step_ = take(gpu::Pipeline::create(*device_, desc));
    desc.name = "sum";
    desc.code = shaders::kTestGraphSumComp;
    desc.layout.bindings = {{0, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE}, {1}};
    desc.layout.push_constant_bytes = sizeof(std::uint32_t);
    sum_ = take(gpu::Pipeline::create(*device_, desc));
    input_ = make_buffer("input", gpu::MemoryUse::kUpload);
    answers_ = make_buffer("answers", gpu::MemoryUse::kReadback);
    const std::span<std::uint32_t> input = input_.mapped<std::uint32_t>();
    for (std::uint32_t i = 0; i < kCount; ++i) input[i] = i * 2654435761u;
  }

  void TearDown() override {
    if (!device_) return;
    device_->wait_idle();
    EXPECT_THAT(device_->validation_log().messages, IsEmpty());
    executor_.reset();
  }

  template <class T>
  static T take(Result<T> result) {
    EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().message);
    return std::move(result).value();
  }

  gpu::Buffer make_buffer(const std::string& name, gpu::MemoryUse memory) {
    return take(gpu::Buffer::create(
        *device_, {name, kCount * sizeof(std::uint32_t),
                   VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT, memory}));
  }

  struct StepData {
    BufferHandle source, target;
  };
  // One more pass of test_graph_step.comp; target: where to, a new transient where it is none.
  BufferHandle add_step(FrameGraph& graph, const std::string& name, BufferHandle source,
                        std::uint32_t factor, std::uint32_t shift, BufferHandle target = {}) {
    return graph
        .add_pass<StepData>(
            name,
            [&](PassBuilder& builder, StepData& data) {
              data.source = source;
              builder.read(source, Access::kStorageReadCompute);
              if (!target)
                target = builder.create_buffer("of " + name, kCount * sizeof(std::uint32_t));
              data.target = builder.write(target, Access::kStorageWriteCompute);
            },
            [this, factor, shift](const StepData& data, PassContext& context) {
              gpu::Commands& commands = context.commands;
              commands.bind_pipeline(step_);
              commands.bind(step_, {gpu::bound_buffer(0, context.buffer(data.source).handle()),
                                    gpu::bound_buffer(1, context.buffer(data.target).handle())});
              commands.push(step_, Push{kCount, factor, shift});
              commands.dispatch((kCount + 63) / 64);
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
    EXPECT_THAT(device_->validation_log().messages, IsEmpty());
    executor_->spoil_plans_for_test(spoil);
    run(std::move(graph));
    executor_->spoil_plans_for_test({});
    std::vector<std::string> messages = device_->validation_log().messages;
    device_->clear_validation_log();
    return messages;
  }

  std::unique_ptr<gpu::Device> device_;
  std::unique_ptr<gpu::Frames> frames_;
  std::unique_ptr<Executor> executor_;
  gpu::Pipeline step_, sum_;
  gpu::Buffer input_, answers_;
};

std::uint32_t find_resource(const Plan& plan, const std::string& name) {
  for (std::uint32_t r = 0; r < plan.graph.resources.size(); ++r)
    if (plan.graph.resources[r].name == name) return r;
  ADD_FAILURE() << "no resource " << name;
  return 0;
}

// Removes every barrier on the resource before that position.
std::function<void(Plan&)> drop_barriers(const std::string& name, std::size_t position) {
  return [name, position](Plan& plan) {
    const std::uint32_t r = find_resource(plan, name);
    auto& list = plan.barriers.before[position];
    EXPECT_GT(std::erase_if(list, [r](const Barrier& b) { return b.resource == r; }), 0u);
  };
}

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
  const std::uint32_t allocations = device_->allocator().statistics().allocations;
  EXPECT_GE(bytes, first->placement.bytes_with_aliasing);
  EXPECT_GT(bytes, 0u);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(run(chain()), first);
  EXPECT_EQ(executor_->transient_bytes(), bytes);
  EXPECT_EQ(device_->allocator().statistics().allocations, allocations);
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

TEST_F(ExecutorTest, PassesAreTimedByName) {
  run(chain());
  run(chain());
  run(chain());
  std::vector<std::string> names;
  for (const gpu::PassTime& time : frames_->pass_times()) names.push_back(time.name);
  if (names.empty()) GTEST_SKIP() << "this queue has no timestamps";
  EXPECT_THAT(names, testing::IsSupersetOf({"one", "two", "three", "four"}));
}

// --- Images
// ---------------------------------------------------------------------------------------

struct PictureData {
  ImageHandle image;
};
struct SumData {
  ImageHandle image;
  BufferHandle sums;
};

class ExecutorImageTest : public ExecutorTest {
 protected:
  // [clear NAME] -> (NAME 1) -> [sum NAME] -> sums + 1: the picture is cleared to red, then summed.
  // how: as a colour attachment, or by a transfer. (Debian 12's synchronization
  // validation, 1.3.239, does not look into dynamic rendering; hazards of attachments are the
  // simulator's to find.)
  BufferHandle add_picture(FrameGraph& graph, const std::string& name, Access how, float red,
                           BufferHandle sums, std::uint32_t factor) {
    const ImageHandle image =
        graph
            .add_pass<PictureData>(
                "clear " + name,
                [&](PassBuilder& builder, PictureData& data) {
                  data.image = builder.write(
                      builder.create_image(name, {VK_FORMAT_R8G8B8A8_UNORM, 33, 17, 2}), how);
                },
                [how, red](const PictureData& data, PassContext& context) {
                  const gpu::Image& target = context.image(data.image);
                  how == Access::kColorAttachment ? clear_by_rendering(context.cmd(), target, red)
                                                  : clear_by_transfer(context.cmd(), target, red);
                })
            .image;
    return graph
        .add_pass<SumData>(
            "sum " + name,
            [&](PassBuilder& builder, SumData& data) {
              data.image = image;
              builder.read(image, Access::kSampledCompute);
              data.sums = builder.write(sums, Access::kStorageWriteCompute);
            },
            [this, factor](const SumData& data, PassContext& context) {
              gpu::Commands& commands = context.commands;
              commands.bind_pipeline(sum_);
              commands.bind(sum_, {gpu::bound_texel_image(0, context.image(data.image).view()),
                                   gpu::bound_buffer(1, context.buffer(data.sums).handle())});
              commands.push(sum_, factor);
              commands.dispatch(5, 3, 2);
            })
        .sums;
  }

  static void clear_by_transfer(VkCommandBuffer cmd, const gpu::Image& image, float red) {
    const VkClearColorValue value{{red, 0.0f, 0.0f, 0.0f}};
    const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0,
                                      VK_REMAINING_ARRAY_LAYERS};
    vkCmdClearColorImage(cmd, image.handle(), access_info(Access::kTransferWrite).layout, &value, 1,
                         &all);
  }

  static void clear_by_rendering(VkCommandBuffer cmd, const gpu::Image& image, float red) {
    VkRenderingAttachmentInfo attachment{};
    attachment.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
    attachment.imageView = image.view();
    attachment.imageLayout = access_info(Access::kColorAttachment).layout;
    attachment.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    attachment.clearValue.color.float32[0] = red;
    VkRenderingInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDERING_INFO;
    info.renderArea.extent = {image.desc().width, image.desc().height};
    info.layerCount = image.desc().layers;
    info.colorAttachmentCount = 1;
    info.pColorAttachments = &attachment;
    vkCmdBeginRendering(cmd, &info);
    vkCmdEndRendering(cmd);
  }

  // Two pictures, one after the other, in the same memory.
  FrameGraph pictures() {
    FrameGraph graph;
    BufferHandle sums = graph.import_buffer("answers", answers_);
    sums = graph
               .add_pass<SumData>(
                   "zero",
                   [&](PassBuilder& builder, SumData& data) {
                     data.sums = builder.write(sums, Access::kTransferWrite);
                   },
                   [](const SumData& data, PassContext& context) {
                     vkCmdFillBuffer(context.cmd(), context.buffer(data.sums).handle(), 0,
                                     VK_WHOLE_SIZE, 0);
                   })
               .sums;
    sums = add_picture(graph, "first", Access::kTransferWrite, 1.0f, sums, 1);
    sums = add_picture(graph, "second", Access::kColorAttachment, 0.2f, sums, 1000);
    graph.output(sums, Access::kHostRead);
    return graph;
  }
};

TEST_F(ExecutorImageTest, PicturesInSharedMemoryGiveTheRightSums) {
  const Plan* plan = run(pictures());
  EXPECT_EQ(plan->placement.offset[find_resource(*plan, "first")],
            plan->placement.offset[find_resource(*plan, "second")]);
  EXPECT_LT(plan->placement.bytes_with_aliasing, plan->placement.bytes_without);
  constexpr std::uint32_t kTexels = 33 * 17;
  EXPECT_EQ(answers()[0], kTexels * 255 + kTexels * 51 * 1000);
  EXPECT_EQ(answers()[1], answers()[0]);
}

TEST_F(ExecutorImageTest, PlantedLayoutMistakeIsCaught) {
  run(pictures());
  const auto messages = validation_after(drop_barriers("second", 4), pictures());
  EXPECT_THAT(messages, Not(IsEmpty()));
}

TEST_F(ExecutorImageTest, PlantedWeakerImageBarrierIsCaught) {
  run(pictures());
  const auto weaken = [](Plan& plan) {
    for (Barrier& barrier : plan.barriers.before[2])
      if (barrier.resource == find_resource(plan, "first"))
        barrier.src_stages = VK_PIPELINE_STAGE_2_NONE, barrier.src_access = VK_ACCESS_2_NONE;
  };
  EXPECT_THAT(validation_after(weaken, pictures()), testing::Contains(HasSubstr("SYNC-HAZARD")));
}

// --- Planted mistakes
// -----------------------------------------------------------------------------

TEST_F(ExecutorTest, PlantedMissingBarrierIsCaught) {
  run(chain());
  for (const auto& [name, position] :
       {std::pair{"of one", 1}, std::pair{"of two", 2}, std::pair{"of three", 3}}) {
    const auto messages =
        validation_after(drop_barriers(name, static_cast<std::size_t>(position)), chain());
    EXPECT_THAT(messages, testing::Contains(HasSubstr("SYNC-HAZARD-READ-AFTER-WRITE"))) << name;
  }
  // The hook is off again, and nothing stuck.
  run(chain());
  EXPECT_EQ(answers(), chain_result());
}

TEST_F(ExecutorTest, PlantedBarrierFromTheWrongStageIsCaught) {
  run(chain());
  const auto wrong_stage = [](Plan& plan) {
    for (Barrier& barrier : plan.barriers.before[1]) {
      barrier.src_stages = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
      barrier.src_access = VK_ACCESS_2_TRANSFER_WRITE_BIT;
    }
  };
  EXPECT_THAT(validation_after(wrong_stage, chain()),
              testing::Contains(HasSubstr("SYNC-HAZARD-READ-AFTER-WRITE")));
}

TEST_F(ExecutorTest, PlantedMissingTakeoverIsCaught) {
  // "of three" takes the memory of "of one" over, which "two" may still be reading.
  run(chain());
  const auto messages = validation_after(drop_barriers("of three", 2), chain());
  EXPECT_THAT(messages, testing::Contains(HasSubstr("SYNC-HAZARD-WRITE-AFTER-READ")));
}

}  // namespace
}  // namespace neritic::graph
