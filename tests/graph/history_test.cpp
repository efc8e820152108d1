// Images that keep their content from frame to frame: an accumulation over frames against the CPU,
// also with frames in flight, after a change of size, after a frame that was dropped; and what is
// refused.
#include <gmock/gmock.h>

#include "executor_fixture.hpp"
#include "graph_maker.hpp"

namespace neritic::graph {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::Each;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::uint32_t kMost = 32;  // texels a side

struct Size {
  std::uint32_t width, height;
};

class HistoryTest : public ExecutorTest {
 protected:
  struct KeepData {
    ImageHandle last, next;
  };
  struct CopyData {
    ImageHandle image;
    BufferHandle texels;
  };

  void SetUp() override {
    ExecutorTest::SetUp();
    if (IsSkipped()) return;
    gpu::ComputePipelineDesc desc;
    desc.name = "keep";
    desc.code = shaders::kTestGraphKeepComp;
    desc.layout.bindings = {{0, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE},
                            {1, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE}};
    desc.layout.push_constant_bytes = sizeof(std::uint32_t);
    keep_ = take(gpu::Pipeline::create(device(), desc));
  }

  gpu::Buffer texel_buffer() {
    return take(gpu::Buffer::create(device(),
                                    {"texels", kMost * kMost * sizeof(std::uint32_t),
                                     VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::MemoryUse::kReadback}));
  }

  static HistoryImages history(FrameGraph& graph, Size size) {
    return graph.history(
        "sum", {VK_FORMAT_R32_UINT, size.width, size.height},
        {Access::kSampledCompute, Access::kStorageWriteCompute, Access::kTransferRead});
  }

  void copy(FrameGraph& graph, ImageHandle image, Size size, const gpu::Buffer& to) {
    const CopyData& copied = graph.add_pass<CopyData>(
        "copy",
        [&](PassBuilder& builder, CopyData& data) {
          data.image = image;
          builder.read(image, Access::kTransferRead);
          data.texels = builder.write(graph.import_buffer("texels", to), Access::kTransferWrite);
        },
        [size](const CopyData& data, PassContext& context) {
          VkBufferImageCopy region{};
          region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
          region.imageExtent = {size.width, size.height, 1};
          vkCmdCopyImageToBuffer(context.cmd(), context.image(data.image).handle(),
                                 VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                                 context.buffer(data.texels).handle(), 1, &region);
        });
    graph.output(copied.texels, Access::kHostRead);
  }

  // (last) -> [keep] -> (next) -> [copy] -> texels
  FrameGraph accumulate(std::uint32_t add, Size size, const gpu::Buffer& to) {
    FrameGraph graph;
    const ImageHandle next =
        graph
            .add_pass<KeepData>(
                "keep",
                [&](PassBuilder& builder, KeepData& data) {
                  const HistoryImages images = history(graph, size);
                  data.last = images.last;
                  builder.read(data.last, Access::kSampledCompute);
                  data.next = builder.write(images.next, Access::kStorageWriteCompute);
                },
                [this, add](const KeepData& data, PassContext& context) {
                  gpu::Commands& commands = context.commands;
                  commands.bind_pipeline(keep_);
                  commands.bind(keep_, {gpu::bound_texel_image(0, context.view(data.last)),
                                        gpu::bound_storage_image(1, context.view(data.next))});
                  commands.push(keep_, add);
                  commands.dispatch(kMost / 8, kMost / 8);
                })
            .next;
    copy(graph, next, size, to);
    return graph;
  }

  FrameGraph show_last(Size size, const gpu::Buffer& to) {
    FrameGraph graph;
    copy(graph, history(graph, size).last, size, to);
    return graph;
  }

  // The texels after all frames since the history began.
  static std::vector<std::uint32_t> expected(const std::vector<std::uint32_t>& adds, Size size) {
    std::vector<std::uint32_t> texels(std::size_t{size.width} * size.height);
    for (const std::uint32_t add : adds)
      for (std::uint32_t y = 0; y < size.height; ++y)
        for (std::uint32_t x = 0; x < size.width; ++x) {
          std::uint32_t& texel = texels[y * size.width + x];
          texel = texel * 3 + add + x + 100 * y;
        }
    return texels;
  }
  static std::vector<std::uint32_t> found(const gpu::Buffer& buffer, Size size) {
    const auto mapped = buffer.mapped<std::uint32_t>();
    return {mapped.begin(), mapped.begin() + size.width * size.height};
  }

  std::uint64_t submit(FrameGraph graph) {
    gpu::Commands* commands = take(frames_->begin());
    take(executor_->run(graph, *commands));
    return take(frames_->submit());
  }

  gpu::Pipeline keep_;
};

constexpr Size kSize{19, 11}, kOther{23, 9};

TEST_F(HistoryTest, AccumulationEqualsTheCpusAndStartsAtZeroAfterAChangeOfSize) {
  const gpu::Buffer texels = texel_buffer();
  std::vector<std::uint32_t> adds;
  for (std::uint32_t i = 0; i < 5; ++i) {
    adds.push_back(7 * i + 1);
    run(accumulate(adds.back(), kSize, texels));
    ASSERT_EQ(found(texels, kSize), expected(adds, kSize)) << i;
  }
  run(accumulate(5, kOther, texels));
  EXPECT_EQ(found(texels, kOther), expected({5}, kOther));
  run(accumulate(6, kOther, texels));
  EXPECT_EQ(found(texels, kOther), expected({5, 6}, kOther));
}

TEST_F(HistoryTest, FramesInFlightFollowEachOther) {
  std::vector<gpu::Buffer> texels;
  for (int i = 0; i < 8; ++i) texels.push_back(texel_buffer());
  std::uint64_t last = 0;
  for (std::uint32_t i = 0; i < 8; ++i)
    last = submit(accumulate(i + 1, i < 5 ? kSize : kOther, texels[i]));
  ASSERT_TRUE(frames_->wait(last).ok());
  for (std::uint32_t i = 0; i < 8; ++i) {
    const Size size = i < 5 ? kSize : kOther;
    std::vector<std::uint32_t> adds;
    for (std::uint32_t k = i < 5 ? 0 : 5; k <= i; ++k) adds.push_back(k + 1);
    EXPECT_EQ(found(texels[i], size), expected(adds, size)) << i;
  }
}

// In one submission synchronization validation sees what one run does to the next.
TEST_F(HistoryTest, RunsOfOneSubmissionAreSafeAndNeedTheirBarriers) {
  const gpu::Buffer texels = texel_buffer(), more = texel_buffer();
  const auto three_runs = [&] {
    gpu::Commands* commands = take(frames_->begin());
    FrameGraph one = accumulate(1, kSize, texels), two = accumulate(2, kSize, more),
               three = accumulate(3, kSize, texels);
    for (FrameGraph* graph : {&one, &two, &three}) take(executor_->run(*graph, *commands));
    ASSERT_TRUE(frames_->wait(take(frames_->submit())).ok());
  };
  three_runs();
  EXPECT_EQ(found(texels, kSize), expected({1, 2, 3}, kSize));
  EXPECT_EQ(found(more, kSize), expected({1, 2}, kSize));
  EXPECT_THAT(device().validation_log().messages, IsEmpty());
  for (const char* name : {"sum (last)", "sum (next)", "texels"}) {
    executor_->spoil_plans_for_test([&](Plan& plan) {
      const std::uint32_t r = find_resource(plan, name);
      for (auto& list : plan.barriers.first)
        std::erase_if(list, [r](const Barrier& b) { return b.resource == r && b.earlier; });
    });
    three_runs();
    EXPECT_FALSE(device().validation_log().messages.empty()) << name;
    device().clear_validation_log();
  }
  executor_->spoil_plans_for_test({});
}

TEST_F(HistoryTest, AFrameThatWritesNothingKeepsTheContent) {
  const gpu::Buffer texels = texel_buffer(), shown = texel_buffer();
  run(show_last(kSize, shown));
  EXPECT_THAT(found(shown, kSize), Each(0u));
  run(accumulate(4, kSize, texels));
  run(show_last(kSize, shown));
  EXPECT_EQ(found(shown, kSize), expected({4}, kSize));
  run(accumulate(5, kSize, texels));
  EXPECT_EQ(found(texels, kSize), expected({4, 5}, kSize));
}

TEST_F(HistoryTest, AFrameThatIsDroppedChangesNothing) {
  const gpu::Buffer texels = texel_buffer();
  const auto drop = [&] {
    gpu::Commands* commands = take(frames_->begin());
    FrameGraph graph = accumulate(99, kSize, texels);
    take(executor_->run(graph, *commands));
  };
  drop();  // its clear was never run either
  run(accumulate(1, kSize, texels));
  EXPECT_EQ(found(texels, kSize), expected({1}, kSize));
  drop();
  drop();
  run(accumulate(2, kSize, texels));
  EXPECT_EQ(found(texels, kSize), expected({1, 2}, kSize));
}

TEST_F(HistoryTest, WhatNoFrameDeclaresIsFreed) {
  const gpu::Buffer texels = texel_buffer();
  EXPECT_EQ(executor_->history_bytes(), 0u);
  run(accumulate(1, kSize, texels));
  EXPECT_GE(executor_->history_bytes(), 2 * 19 * 11 * sizeof(std::uint32_t));
  for (int i = 0; i < 200; ++i) run(chain());
  EXPECT_GT(executor_->history_bytes(), 0u);
  for (int i = 0; i < 100; ++i) run(chain());
  EXPECT_EQ(executor_->history_bytes(), 0u);
  run(accumulate(3, kSize, texels));
  EXPECT_EQ(found(texels, kSize), expected({3}, kSize));
}

// --- Refusals

struct HistoryMaker : GraphMaker {
  std::uint32_t last, next;
  HistoryMaker() {
    last = imported_image("sum (last)", 0, 0, VK_IMAGE_LAYOUT_UNDEFINED);
    next = imported_image("sum (next)", 0, 0, VK_IMAGE_LAYOUT_UNDEFINED);
    graph.resources[last].history = History::kLast;
    graph.resources[next].history = History::kNext;
    graph.resources[last].mips = graph.resources[next].mips = 2;
  }
};

TEST(HistoryDecl, OnlyTheLastCanBeReadAndOnlyTheNextWritten) {
  HistoryMaker fine, read, write;
  fine.pass("P", {use(fine.last, 0, Access::kSampledCompute), use(fine.next, 0, kWrite)}, true);
  EXPECT_THAT(fine.error(), IsEmpty());
  read.pass("P", {use(read.next, 0, Access::kSampledCompute)}, true);
  EXPECT_THAT(read.error(), AllOf(HasSubstr("\"P\" reads \"sum (next)\" before any pass")));
  write.pass("P", {use(write.last, 0, kWrite)}, true);
  EXPECT_THAT(write.error(), AllOf(HasSubstr("\"P\" writes \"sum (last)\""), HasSubstr("only")));
}

TEST(HistoryDecl, TheNextIsWrittenWholeOrNotAtAll) {
  HistoryMaker m;
  m.pass("P", {use(m.next, 0, kWrite, mip(0))}, true);
  const Result<Plan> part = plan_with(m.graph, m.needs());
  ASSERT_FALSE(part.ok());
  EXPECT_EQ(part.error().message, "frame graph: \"sum (next)\" is written only in part");
  m.pass("Q", {use(m.next, 1, kWrite, mip(1))}, true);
  EXPECT_TRUE(plan_with(m.graph, m.needs()).ok());
}

}  // namespace
}  // namespace neritic::graph
