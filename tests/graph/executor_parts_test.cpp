// Parts of images on the device: a mip pyramid made by passes that read one mip and write the next,
// against the CPU; a depth image that is tested and sampled in one pass.
#include <algorithm>

#include "executor_fixture.hpp"

namespace neritic::graph {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr std::uint32_t kWidth = 37, kHeight = 22, kLayers = 2, kMips = 6;

using Texels = std::vector<std::uint32_t>;

// The same computation as test_graph_mip.comp, for all layers of one mip.
Texels next_mip(const Texels& above, std::uint32_t width, std::uint32_t height) {
  const std::uint32_t w = std::max(width / 2, 1u), h = std::max(height / 2, 1u);
  Texels below;
  for (std::uint32_t layer = 0; layer < kLayers; ++layer)
    for (std::uint32_t y = 0; y < h; ++y)
      for (std::uint32_t x = 0; x < w; ++x) {
        std::uint32_t sum = 0;
        for (std::uint32_t dy = 0; dy < 2; ++dy)
          for (std::uint32_t dx = 0; dx < 2; ++dx)
            if (2 * x + dx < width && 2 * y + dy < height)
              sum += above[(layer * height + 2 * y + dy) * width + 2 * x + dx];
        below.push_back(sum * 3 + 1);
      }
  return below;
}

class ExecutorPartsTest : public ExecutorTest {
 protected:
  struct MipData {
    ImageHandle above, below;
  };
  struct CopyData {
    ImageHandle image;
    BufferHandle buffer;
  };

  void SetUp() override {
    ExecutorTest::SetUp();
    if (IsSkipped()) return;
    gpu::ComputePipelineDesc desc;
    desc.name = "mip";
    desc.code = shaders::kTestGraphMipComp;
    desc.layout.bindings = {{0, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE},
                            {1, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE}};
    mip_ = take(gpu::Pipeline::create(device(), desc));
    std::uint32_t w = kWidth, h = kHeight;
    Texels texels;
    for (std::uint32_t i = 0; i < w * h * kLayers; ++i) texels.push_back(i * 2654435761u);
    for (std::uint32_t m = 0; m < kMips; ++m) {
      expected_.insert(expected_.end(), texels.begin(), texels.end());
      texels = next_mip(texels, w, h);
      w = std::max(w / 2, 1u), h = std::max(h / 2, 1u);
    }
    pixels_ = take(
        gpu::Buffer::create(device(), {"pixels", kWidth * kHeight * kLayers * sizeof(std::uint32_t),
                                       VK_BUFFER_USAGE_TRANSFER_SRC_BIT, gpu::MemoryUse::kUpload}));
    std::copy_n(expected_.begin(), kWidth * kHeight * kLayers,
                pixels_.mapped<std::uint32_t>().begin());
    all_mips_ = take(gpu::Buffer::create(
        device(), {"all mips", expected_.size() * sizeof(std::uint32_t),
                   VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::MemoryUse::kReadback}));
  }

  // The copies of all mips between the image and a buffer that has one after the other.
  static std::vector<VkBufferImageCopy> copies(std::uint32_t mips) {
    std::vector<VkBufferImageCopy> regions(mips);
    VkDeviceSize offset = 0;
    for (std::uint32_t m = 0; m < mips; ++m) {
      const std::uint32_t w = std::max(kWidth >> m, 1u), h = std::max(kHeight >> m, 1u);
      regions[m].bufferOffset = offset;
      regions[m].imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, m, 0, kLayers};
      regions[m].imageExtent = {w, h, 1};
      offset += VkDeviceSize{w} * h * kLayers * sizeof(std::uint32_t);
    }
    return regions;
  }

  // [base] -> mip 0 -> [mip 1] -> mip 1 -> ... ; all of them -> [copy] -> all mips
  FrameGraph pyramid() {
    FrameGraph graph;
    ImageHandle image =
        graph
            .add_pass<CopyData>(
                "base",
                [&](PassBuilder& builder, CopyData& data) {
                  data.buffer = graph.import_buffer("pixels", pixels_);
                  builder.read(data.buffer, Access::kTransferRead);
                  const ImageHandle fresh = builder.create_image(
                      "pyramid", {VK_FORMAT_R32_UINT, kWidth, kHeight, kLayers, kMips});
                  data.image = builder.write(fresh.mip(0), Access::kTransferWrite);
                },
                [](const CopyData& data, PassContext& context) {
                  vkCmdCopyBufferToImage(context.cmd(), context.buffer(data.buffer).handle(),
                                         context.image(data.image).handle(),
                                         VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, copies(1).data());
                })
            .image;
    for (std::uint32_t m = 1; m < kMips; ++m)
      image =
          graph
              .add_pass<MipData>(
                  "mip " + std::to_string(m),
                  [&](PassBuilder& builder, MipData& data) {
                    data.above = image.mip(m - 1);
                    builder.read(data.above, Access::kSampledCompute);
                    data.below = builder.write(image.mip(m), Access::kStorageWriteCompute);
                  },
                  [this](const MipData& data, PassContext& context) {
                    gpu::Commands& commands = context.commands;
                    commands.bind_pipeline(mip_);
                    commands.bind(mip_, {gpu::bound_texel_image(0, context.view(data.above)),
                                         gpu::bound_storage_image(1, context.view(data.below))});
                    commands.dispatch(3, 2, kLayers);
                  })
              .below;
    const CopyData& copied = graph.add_pass<CopyData>(
        "copy",
        [&](PassBuilder& builder, CopyData& data) {
          data.image = image.whole();
          builder.read(data.image, Access::kTransferRead);
          data.buffer =
              builder.write(graph.import_buffer("all mips", all_mips_), Access::kTransferWrite);
        },
        [](const CopyData& data, PassContext& context) {
          vkCmdCopyImageToBuffer(context.cmd(), context.image(data.image).handle(),
                                 VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                                 context.buffer(data.buffer).handle(), kMips, copies(kMips).data());
        });
    graph.output(copied.buffer, Access::kHostRead);
    return graph;
  }

  gpu::Pipeline mip_;
  gpu::Buffer pixels_, all_mips_;
  Texels expected_;  // all mips, one after the other
};

TEST_F(ExecutorPartsTest, MipPyramidEqualsTheCpus) {
  for (int frame = 0; frame < 3; ++frame) {
    std::ranges::fill(all_mips_.mapped<std::uint32_t>(), 0u);
    run(pyramid());
    const auto found = all_mips_.mapped<std::uint32_t>();
    ASSERT_EQ(Texels(found.begin(), found.end()), expected_);
  }
}

TEST_F(ExecutorPartsTest, PlantedMissingBarrierOfAMipIsCaught) {
  run(pyramid());
  for (const std::size_t position : {1u, 3u, 5u, 6u})
    EXPECT_THAT(validation_after(drop_barriers("pyramid", position), pyramid()), Not(IsEmpty()))
        << position;
  const auto skip_mip = [](Plan& plan) {  // waits for the wrong mip only
    for (Barrier& barrier : plan.barriers.before[3]) barrier.range.mip = 1;  // 2 is read
  };
  EXPECT_THAT(validation_after(skip_mip, pyramid()), Not(IsEmpty()));
}

// --- Depth that is tested and sampled

constexpr float kClearDepth = 0.5f;
constexpr std::uint32_t kSide = 40;  // texels

class DepthTestAndSampledTest : public ExecutorTest {
 protected:
  struct DrawData {
    ImageHandle depth, color;
  };
  struct CopyData {
    ImageHandle color;
    BufferHandle texels;
  };

  void SetUp() override {
    ExecutorTest::SetUp();
    if (IsSkipped()) return;
    gpu::GraphicsPipelineDesc desc;
    desc.name = "depth test and sampled";
    desc.vertex_code = shaders::kTestGraphDepthVert;
    desc.fragment_code = shaders::kTestGraphDepthFrag;
    desc.layout.bindings = {{0, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE}};
    desc.color_formats = {VK_FORMAT_R8G8B8A8_UNORM};
    desc.depth_format = VK_FORMAT_D32_SFLOAT;
    desc.depth_write = false;
    draw_ = take(gpu::Pipeline::create(device(), desc));
    texels_ = take(gpu::Buffer::create(
        device(), {"texels", kSide * kSide * sizeof(std::uint32_t),
                   VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::MemoryUse::kReadback}));
  }

  static VkRenderingAttachmentInfo attachment(VkImageView view, VkImageLayout layout,
                                              VkAttachmentLoadOp load, VkAttachmentStoreOp store) {
    VkRenderingAttachmentInfo info{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    info.imageView = view;
    info.imageLayout = layout;
    info.loadOp = load;
    info.storeOp = store;
    return info;
  }

  static void render(VkCommandBuffer cmd, const VkRenderingAttachmentInfo* color,
                     const VkRenderingAttachmentInfo& depth, const std::function<void()>& draw) {
    VkRenderingInfo info{VK_STRUCTURE_TYPE_RENDERING_INFO};
    info.renderArea.extent = {kSide, kSide};
    info.layerCount = 1;
    info.colorAttachmentCount = color ? 1 : 0;
    info.pColorAttachments = color;
    info.pDepthAttachment = &depth;
    vkCmdBeginRendering(cmd, &info);
    const VkViewport viewport{0, 0, kSide, kSide, 0, 1};
    vkCmdSetViewport(cmd, 0, 1, &viewport);
    vkCmdSetScissor(cmd, 0, 1, &info.renderArea);
    vkCmdSetCullMode(cmd, VK_CULL_MODE_NONE);
    vkCmdSetFrontFace(cmd, VK_FRONT_FACE_COUNTER_CLOCKWISE);
    draw();
    vkCmdEndRendering(cmd);
  }

  void record_draw(const DrawData& data, PassContext& context) const {
    constexpr VkImageLayout kRead = VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL;
    gpu::Commands& commands = context.commands;
    const auto color =
        attachment(context.view(data.color), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                   VK_ATTACHMENT_LOAD_OP_CLEAR, VK_ATTACHMENT_STORE_OP_STORE);
    const auto depth = attachment(context.view(data.depth), kRead, VK_ATTACHMENT_LOAD_OP_LOAD,
                                  VK_ATTACHMENT_STORE_OP_NONE);
    commands.bind_pipeline(draw_);
    commands.bind(draw_, {gpu::bound_texel_image(0, context.view(data.depth), kRead)});
    render(context.cmd(), &color, depth, [&] { vkCmdDraw(context.cmd(), 3, 1, 0, 0); });
  }

  // [clear] -> (depth 1) | [draw] tests against it and samples it -> (color) -> [copy] -> texels
  FrameGraph graph(Access how) {
    FrameGraph graph;
    const DrawData cleared = graph.add_pass<DrawData>(
        "clear",
        [](PassBuilder& builder, DrawData& data) {
          data.depth =
              builder.write(builder.create_image("depth", {VK_FORMAT_D32_SFLOAT, kSide, kSide}),
                            Access::kDepthAttachment);
        },
        [](const DrawData& data, PassContext& context) {
          auto depth =
              attachment(context.view(data.depth), VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
                         VK_ATTACHMENT_LOAD_OP_CLEAR, VK_ATTACHMENT_STORE_OP_STORE);
          depth.clearValue.depthStencil.depth = kClearDepth;
          render(context.cmd(), nullptr, depth, [] {});
        });
    const DrawData drawn = graph.add_pass<DrawData>(
        "draw",
        [&](PassBuilder& builder, DrawData& data) {
          data.depth = cleared.depth;
          builder.read(data.depth, how);
          data.color =
              builder.write(builder.create_image("color", {VK_FORMAT_R8G8B8A8_UNORM, kSide, kSide}),
                            Access::kColorAttachment);
        },
        [this](const DrawData& data, PassContext& context) { record_draw(data, context); });
    const CopyData& copied = graph.add_pass<CopyData>(
        "copy",
        [&](PassBuilder& builder, CopyData& data) {
          data.color = drawn.color;
          builder.read(data.color, Access::kTransferRead);
          data.texels =
              builder.write(graph.import_buffer("texels", texels_), Access::kTransferWrite);
        },
        [](const CopyData& data, PassContext& context) {
          VkBufferImageCopy region{};
          region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
          region.imageExtent = {kSide, kSide, 1};
          vkCmdCopyImageToBuffer(context.cmd(), context.image(data.color).handle(),
                                 VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                                 context.buffer(data.texels).handle(), 1, &region);
        });
    graph.output(copied.texels, Access::kHostRead);
    return graph;
  }

  gpu::Pipeline draw_;
  gpu::Buffer texels_;
};

TEST_F(DepthTestAndSampledTest, FragmentsThatPassSeeTheDepthThatTheyPassed) {
  run(graph(Access::kDepthTestAndSampled));
  const auto texels = texels_.mapped<std::uint8_t>();
  for (std::uint32_t y = 0; y < kSide; ++y)
    for (std::uint32_t x = 0; x < kSide; ++x) {
      // The triangle's depth is 2 x / side / 2; reversed-Z: what is at least the clear depth
      // passes.
      const bool passes = (x + 0.5f) / kSide >= kClearDepth;
      ASSERT_NEAR(texels[4 * (y * kSide + x)], passes ? 255 * kClearDepth : 0.0, 1.0)
          << x << ", " << y;
    }
}

TEST_F(DepthTestAndSampledTest, SamplingWithoutTheDeclaredAccessIsCaught) {
  // Declared for the test alone, the image lacks the usage; validation says so.
  run(graph(Access::kDepthTest));
  EXPECT_THAT(device().validation_log().messages, Not(IsEmpty()));
  device().clear_validation_log();
}

}  // namespace
}  // namespace neritic::graph
