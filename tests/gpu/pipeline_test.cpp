// Compute and graphics pipelines do what their descriptions say.
#include "engine/gpu/pipeline.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <set>

#include "engine/gpu/pipeline_shelf.hpp"
#include "shaders.hpp"
#include "tests/support/gpu_fixture.hpp"

namespace neritic::gpu {
namespace {

class PipelineTest : public test::GpuTest {
 protected:
  Result<Buffer> readback(VkDeviceSize size) {
    BufferDesc desc;
    desc.name = "result";
    desc.size = size;
    desc.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    desc.memory = MemoryUse::kReadback;
    return Buffer::create(device(), desc);
  }
  Result<Pipeline> fill(std::uint32_t factor) {
    ComputePipelineDesc desc;
    desc.name = "fill";
    desc.code = shaders::kTestFillComp;
    desc.layout.bindings = {{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
                            {1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
                            {2, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER}};
    desc.layout.push_constant_bytes = 8;
    desc.constants = {{0, factor}};
    return Pipeline::create(device(), desc);
  }
};

void host_barrier(VkCommandBuffer commands) {
  VkMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
  barrier.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
  barrier.dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT;
  barrier.dstAccessMask = VK_ACCESS_2_HOST_READ_BIT;
  VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  info.memoryBarrierCount = 1;
  info.pMemoryBarriers = &barrier;
  vkCmdPipelineBarrier2(commands, &info);
}

// The count is deliberately no multiple of the group size.
TEST_F(PipelineTest, ComputeReadsBuffersUniformPushAndSpecialization) {
  constexpr std::uint32_t kCount = 1000, kGuard = 24;
  NERITIC_ASSERT_OK(const Pipeline pipeline, fill(7));
  NERITIC_ASSERT_OK(const Buffer result, readback(4 * (kCount + kGuard)));
  for (std::uint32_t& value : result.mapped<std::uint32_t>()) value = 0xdeadbeef;
  std::vector<std::uint32_t> input(kCount);
  for (std::uint32_t i = 0; i < kCount; ++i) input[i] = i * i;
  const std::uint32_t bias = 5;

  NERITIC_ASSERT_OK(const auto frames, Frames::create(device()));
  NERITIC_ASSERT_OK(Commands * commands, frames->begin());
  const UploadSlice in = commands->upload(std::span<const std::uint32_t>(input));
  const UploadSlice uniform = commands->upload(&bias, sizeof bias);
  commands->bind_pipeline(pipeline);
  commands->bind(pipeline,
                 {bound_buffer(0, in.buffer, in.offset, in.size), bound_buffer(1, result.handle()),
                  bound_buffer(2, uniform.buffer, uniform.offset, uniform.size)});
  commands->push(pipeline, std::array<std::uint32_t, 2>{kCount, 100});
  commands->dispatch((kCount + 63) / 64);
  host_barrier(commands->handle());
  NERITIC_ASSERT_OK(const std::uint64_t frame, frames->submit());
  NERITIC_ASSERT_STATUS(frames->wait(frame));

  const auto values = result.mapped<const std::uint32_t>();
  for (std::uint32_t i = 0; i < kCount; ++i) ASSERT_EQ(values[i], 7 * i * i + 105) << i;
  for (std::uint32_t i = kCount; i < kCount + kGuard; ++i) ASSERT_EQ(values[i], 0xdeadbeefu) << i;
}

using PipelineDeathTest = PipelineTest;

TEST_F(PipelineDeathTest, AMissingOrUnknownBindingStops) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");  // the device has threads
  NERITIC_ASSERT_OK(const Pipeline pipeline, fill(1));
  NERITIC_ASSERT_OK(const Buffer some, readback(64));
  DescriptorArena arena(device(), "test");
  NERITIC_ASSERT_OK(const VkDescriptorSet set, arena.allocate(pipeline.set0(), "test"));
  const std::array missing{bound_buffer(0, some.handle()), bound_buffer(1, some.handle())};
  EXPECT_DEATH(write_descriptors(device(), set, pipeline.bindings(), missing),
               "binding 2 is given 0");
  const std::array unknown{bound_buffer(9, some.handle())};
  EXPECT_DEATH(write_descriptors(device(), set, pipeline.bindings(), unknown), "9 is not declared");
}

TEST_F(PipelineTest, DescriptorArenasGrowAndStartOver) {
  NERITIC_ASSERT_OK(const Pipeline pipeline, fill(1));
  DescriptorArena arena(device(), "test");
  for (int round = 0; round < 3; ++round) {
    std::vector<VkDescriptorSet> sets;
    for (int i = 0; i < 1000; ++i) {
      NERITIC_ASSERT_OK(const VkDescriptorSet set, arena.allocate(pipeline.set0(), "test"));
      sets.push_back(set);
    }
    std::sort(sets.begin(), sets.end());
    EXPECT_EQ(std::adjacent_find(sets.begin(), sets.end()), sets.end()) << "a set was given twice";
    arena.reset();
  }
}

// --- Drawing ----------------------------------------------------------------------------------

constexpr std::uint32_t kSide = 32;

struct TrianglePush {
  float offset_x[2] = {0.0f, 0.0f};
  std::uint32_t burn_steps = 0;
};

class TriangleTest : public PipelineTest {
 protected:
  void SetUp() override {
    PipelineTest::SetUp();
    if (IsSkipped()) return;
    color_ = make(VK_FORMAT_R8G8B8A8_UNORM, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    depth_ = make(VK_FORMAT_D32_SFLOAT, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
    auto frames = Frames::create(device());
    ASSERT_TRUE(frames.ok());
    frames_ = std::move(frames).value();
  }
  void TearDown() override {
    frames_.reset();
    color_ = Image();
    depth_ = Image();
    PipelineTest::TearDown();
  }
  Image make(VkFormat format, VkImageUsageFlags usage) {
    ImageDesc desc;
    desc.name = format == VK_FORMAT_D32_SFLOAT ? "depth" : "color";
    desc.format = format;
    desc.width = desc.height = kSide;
    desc.layers = 2;
    desc.usage = usage | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    desc.array_view = true;
    auto image = Image::create(device(), desc);
    EXPECT_TRUE(image.ok());
    return std::move(image).value();
  }
  static GraphicsPipelineDesc triangle() {
    GraphicsPipelineDesc desc;
    desc.name = "triangle";
    desc.vertex_code = shaders::kTestTriangleVert;
    desc.fragment_code = shaders::kTestTriangleFrag;
    desc.layout.push_constant_bytes = sizeof(TrianglePush);
    desc.streams = {{12, {{0, VK_FORMAT_R32G32B32_SFLOAT, 0}}, false},
                    {16, {{1, VK_FORMAT_R32G32B32A32_SFLOAT, 0}}, true}};
    desc.color_formats = {VK_FORMAT_R8G8B8A8_UNORM};
    desc.depth_format = VK_FORMAT_D32_SFLOAT;
    desc.view_mask = 0b11;
    return desc;
  }
  struct Draw {
    const Pipeline* pipeline;
    std::vector<float> positions;
    std::vector<float> color;
    TrianglePush push;
    VkCullModeFlags cull = VK_CULL_MODE_NONE;
  };
  // Clears to opaque blue and depth 0, draws, leaves both images in TRANSFER_SRC.
  void render(std::span<const Draw> draws, bool with_color = true);
  std::uint32_t texel(std::uint32_t layer, std::uint32_t x, std::uint32_t y) {
    auto bytes = read_image(device(), color_, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, layer);
    EXPECT_TRUE(bytes.ok());
    std::uint32_t value = 0;
    std::memcpy(&value, bytes->data() + 4 * (y * kSide + x), 4);
    return value;
  }
  float depth_at(std::uint32_t layer, std::uint32_t x, std::uint32_t y) {
    auto bytes = read_image(device(), depth_, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, layer);
    EXPECT_TRUE(bytes.ok());
    float value = 0;
    std::memcpy(&value, bytes->data() + 4 * (y * kSide + x), 4);
    return value;
  }

  Image color_, depth_;
  std::unique_ptr<Frames> frames_;
};

void image_barrier(VkCommandBuffer commands, const Image& image, VkImageLayout from,
                   VkImageLayout to) {
  VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
  barrier.srcStageMask = barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
  barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
  barrier.oldLayout = from;
  barrier.newLayout = to;
  barrier.image = image.handle();
  barrier.subresourceRange = {image.aspect(), 0, 1, 0, image.desc().layers};
  VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  info.imageMemoryBarrierCount = 1;
  info.pImageMemoryBarriers = &barrier;
  vkCmdPipelineBarrier2(commands, &info);
}

void TriangleTest::render(std::span<const Draw> draws, bool with_color) {
  NERITIC_ASSERT_OK(Commands * commands, frames_->begin());
  const VkCommandBuffer cmd = commands->handle();
  image_barrier(cmd, color_, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
  image_barrier(cmd, depth_, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL);
  VkRenderingAttachmentInfo color{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
  color.imageView = color_.view();
  color.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  color.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
  color.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  color.clearValue.color = {{0.0f, 0.0f, 1.0f, 1.0f}};
  VkRenderingAttachmentInfo depth = color;
  depth.imageView = depth_.view();
  depth.imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
  depth.clearValue.depthStencil = {0.0f, 0};
  VkRenderingInfo info{VK_STRUCTURE_TYPE_RENDERING_INFO};
  info.renderArea = {{0, 0}, {kSide, kSide}};
  info.layerCount = 1;
  info.viewMask = 0b11;
  info.colorAttachmentCount = with_color ? 1 : 0;
  info.pColorAttachments = &color;
  info.pDepthAttachment = &depth;
  commands->begin_region("draw");
  vkCmdBeginRendering(cmd, &info);
  const VkViewport viewport{0, 0, kSide, kSide, 0, 1};
  const VkRect2D scissor{{0, 0}, {kSide, kSide}};
  vkCmdSetViewport(cmd, 0, 1, &viewport);
  vkCmdSetScissor(cmd, 0, 1, &scissor);
  vkCmdSetFrontFace(cmd, VK_FRONT_FACE_COUNTER_CLOCKWISE);
  for (const Draw& draw : draws) {
    vkCmdSetCullMode(cmd, draw.cull);
    commands->bind_pipeline(*draw.pipeline);
    commands->push(*draw.pipeline, draw.push);
    const UploadSlice positions = commands->upload(std::span<const float>(draw.positions));
    const UploadSlice colors = commands->upload(std::span<const float>(draw.color));
    const std::array buffers{positions.buffer, colors.buffer};
    const std::array<VkDeviceSize, 2> offsets{positions.offset, colors.offset};
    vkCmdBindVertexBuffers(cmd, 0, 2, buffers.data(), offsets.data());
    vkCmdDraw(cmd, 3, 1, 0, 0);
  }
  vkCmdEndRendering(cmd);
  commands->end_region();
  image_barrier(cmd, color_,
                with_color ? VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL : VK_IMAGE_LAYOUT_UNDEFINED,
                VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
  image_barrier(cmd, depth_, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
                VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
  NERITIC_ASSERT_OK(const std::uint64_t frame, frames_->submit());
  NERITIC_ASSERT_STATUS(frames_->wait(frame));
}

// A right triangle over the upper left half of clip space (y down), at depth z; it winds
// counter-clockwise in Vulkan's framebuffer (down the left edge, then to the right corner).
std::vector<float> upper_left(float z) {
  return {-1, -1, z, -1, 1, z, 1, -1, z};
}

constexpr std::uint32_t kBlue = 0xffff0000, kRed = 0xff0000ff, kGreen = 0xff00ff00;

TEST_F(TriangleTest, OnePassDrawsBothViewsEachWithItsOwnOffset) {
  NERITIC_ASSERT_OK(const Pipeline pipeline, Pipeline::create(device(), triangle()));
  const std::array draws{Draw{&pipeline, upper_left(0.5f), {1, 0, 0, 1}, {{0.0f, 1.0f}, 0}}};
  ASSERT_NO_FATAL_FAILURE(render(draws));
  EXPECT_EQ(texel(0, 2, 2), kRed);
  EXPECT_EQ(texel(0, kSide - 3, kSide - 3), kBlue);
  EXPECT_EQ(texel(1, 2, 2), kBlue);  // moved right by half the picture
  EXPECT_EQ(texel(1, kSide / 2 + 2, 2), kRed);
  EXPECT_FLOAT_EQ(depth_at(0, 2, 2), 0.5f);
  EXPECT_FLOAT_EQ(depth_at(1, 2, 2), 0.0f);
}

TEST_F(TriangleTest, TheNearerWinsUnderReversedDepth) {
  NERITIC_ASSERT_OK(const Pipeline pipeline, Pipeline::create(device(), triangle()));
  const Draw near{&pipeline, upper_left(0.9f), {1, 0, 0, 1}, {}};
  const Draw far{&pipeline, upper_left(0.1f), {0, 1, 0, 1}, {}};
  ASSERT_NO_FATAL_FAILURE(render(std::array{near, far}));
  EXPECT_EQ(texel(0, 2, 2), kRed);
  ASSERT_NO_FATAL_FAILURE(render(std::array{far, near}));
  EXPECT_EQ(texel(0, 2, 2), kRed);
}

TEST_F(TriangleTest, DepthIsTestedButNotWrittenWhereSaidSo) {
  GraphicsPipelineDesc desc = triangle();
  desc.depth_write = false;
  NERITIC_ASSERT_OK(const Pipeline pipeline, Pipeline::create(device(), desc));
  const Draw near{&pipeline, upper_left(0.9f), {1, 0, 0, 1}, {}};
  const Draw far{&pipeline, upper_left(0.1f), {0, 1, 0, 1}, {}};
  ASSERT_NO_FATAL_FAILURE(render(std::array{near, far}));
  EXPECT_EQ(texel(0, 2, 2), kGreen);
  EXPECT_FLOAT_EQ(depth_at(0, 2, 2), 0.0f);
}

TEST_F(TriangleTest, CullingFollowsTheDynamicState) {
  NERITIC_ASSERT_OK(const Pipeline pipeline, Pipeline::create(device(), triangle()));
  Draw draw{&pipeline, upper_left(0.5f), {1, 0, 0, 1}, {}, VK_CULL_MODE_BACK_BIT};
  ASSERT_NO_FATAL_FAILURE(render(std::array{draw}));
  EXPECT_EQ(texel(0, 2, 2), kRed);
  draw.cull = VK_CULL_MODE_FRONT_BIT;
  ASSERT_NO_FATAL_FAILURE(render(std::array{draw}));
  EXPECT_EQ(texel(0, 2, 2), kBlue);
}

TEST_F(TriangleTest, AlphaOverKeepsWhatTransparencyLetsThrough) {
  GraphicsPipelineDesc desc = triangle();
  desc.blend = Blend::kAlphaOver;
  NERITIC_ASSERT_OK(const Pipeline pipeline, Pipeline::create(device(), desc));
  // Premultiplied: a fifth of red over opaque blue leaves four fifths of blue.
  ASSERT_NO_FATAL_FAILURE(
      render(std::array{Draw{&pipeline, upper_left(0.5f), {0.2f, 0, 0, 0.2f}, {}}}));
  EXPECT_EQ(texel(0, 2, 2), 0xffcc0033u);
}

TEST_F(TriangleTest, WithoutFragmentCodeOnlyDepthIsWritten) {
  GraphicsPipelineDesc desc = triangle();
  desc.fragment_code = {};
  desc.color_formats = {};
  NERITIC_ASSERT_OK(const Pipeline pipeline, Pipeline::create(device(), desc));
  ASSERT_NO_FATAL_FAILURE(
      render(std::array{Draw{&pipeline, upper_left(0.25f), {1, 1, 1, 1}, {}}}, false));
  EXPECT_FLOAT_EQ(depth_at(0, 2, 2), 0.25f);
  EXPECT_FLOAT_EQ(depth_at(1, 2, 2), 0.25f);
  EXPECT_FLOAT_EQ(depth_at(0, kSide - 3, kSide - 3), 0.0f);
}

TEST_F(TriangleTest, TheTimeOfADrawIsTheWorkOfItsFragments) {
  if (device().timestamp_valid_bits() == 0) GTEST_SKIP() << "the queue has no timestamps";
  NERITIC_ASSERT_OK(const Pipeline pipeline, Pipeline::create(device(), triangle()));
  Draw draw{&pipeline, upper_left(0.5f), {1, 0, 0, 1}, {}};
  double light_ms = 0.0;
  for (int i = 0; i < 3; ++i) {  // the first compiles shaders
    ASSERT_NO_FATAL_FAILURE(render(std::array{draw}));
    light_ms = frames_->pass_times().at(1).ms;
  }
  draw.push.burn_steps = 200'000;
  ASSERT_NO_FATAL_FAILURE(render(std::array{draw}));
  ASSERT_EQ(frames_->pass_times().at(1).name, "draw");
  EXPECT_GT(frames_->pass_times().at(1).ms, 4 * light_ms);
}

TEST_F(TriangleTest, MoreViewsThanTheDeviceHasIsAnError) {
  GraphicsPipelineDesc desc = triangle();
  desc.view_mask = 0x80000000u;
  const auto made = Pipeline::create(device(), desc);
  ASSERT_FALSE(made.ok());
  EXPECT_EQ(made.error().code, ErrorCode::kUnsupported);
}

// Equal descriptions are one pipeline of the driver, also after all its owners are gone.
TEST_F(PipelineTest, EqualDescriptionsShareOneOfTheDrivers) {
  VkPipeline first = VK_NULL_HANDLE;
  {
    NERITIC_ASSERT_OK(const Pipeline a, fill(7));
    NERITIC_ASSERT_OK(const Pipeline b, fill(7));
    NERITIC_ASSERT_OK(const Pipeline c, fill(8));
    EXPECT_EQ(a.handle(), b.handle());
    EXPECT_NE(a.handle(), c.handle());
    first = a.handle();
  }
  NERITIC_ASSERT_OK(const Pipeline again, fill(7));
  EXPECT_EQ(again.handle(), first);
}

TEST_F(TriangleTest, EveryPartOfADescriptionTellsPipelinesApart) {
  std::set<std::string> keys;
  std::size_t made = 0;
  const auto differs = [&](const auto& desc) {
    keys.insert(pipeline_key(desc));
    EXPECT_EQ(keys.size(), ++made) << made;
  };
  ComputePipelineDesc compute;
  compute.name = "fill";
  compute.code = shaders::kTestFillComp;
  compute.layout.bindings = {{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}};
  differs(compute);
  ComputePipelineDesc other = compute;
  other.code = shaders::kTestTriangleVert;
  differs(other);
  other = compute;
  other.constants = {{0, 1}};
  differs(other);
  other.constants = {{1, 0}};
  differs(other);
  other = compute;
  other.layout.push_constant_bytes = 8;
  differs(other);
  other = compute;
  other.layout.bindings[0].count = 2;
  differs(other);
  other = compute;
  NERITIC_ASSERT_OK(const SetLayout set, SetLayout::create(device(), "set", compute.layout.bindings,
                                                           VK_SHADER_STAGE_COMPUTE_BIT));
  other.layout.other_sets = {&set};
  differs(other);
  other.layout.other_sets = {&set, &set};
  differs(other);

  const GraphicsPipelineDesc graphics = triangle();
  differs(graphics);
  const auto with = [&](auto change) {
    GraphicsPipelineDesc desc = graphics;
    change(desc);
    differs(desc);
  };
  with([](auto& d) { d.topology = VK_PRIMITIVE_TOPOLOGY_LINE_LIST; });
  with([](auto& d) { d.color_formats.push_back(VK_FORMAT_R8G8B8A8_UNORM); });
  with([](auto& d) { d.color_formats[0] = VK_FORMAT_R32_UINT; });
  with([](auto& d) { d.depth_format = VK_FORMAT_D16_UNORM; });
  with([](auto& d) { d.depth_write = false; });
  with([](auto& d) { d.depth_compare = VK_COMPARE_OP_EQUAL; });
  with([](auto& d) { d.blend = Blend::kTinted; });
  with([](auto& d) { d.view_mask = 1; });
  with([](auto& d) { d.streams.push_back({.stride = 12}); });
  with([](auto& d) { d.streams.push_back({.stride = 12, .per_instance = true}); });
  with([](auto& d) { d.streams.push_back({.stride = 12, .attributes = {{}}}); });
  with([](auto& d) { d.fragment_code = {}; });
}

TEST_F(PipelineTest, TheShelfKeepsSoManyThatNobodyUses) {
  PipelineShelf shelf;
  int made = 0;
  const auto get = [&](int i) {
    return shelf.get(fmt::format("{}", i), [&]() -> Result<PipelineShelf::Made> {
      ++made;
      return PipelineShelf::Made(std::make_shared<MadePipeline>());
    });
  };
  NERITIC_ASSERT_OK(const auto used, get(0));
  const int last = static_cast<int>(PipelineShelf::kUnusedKept) + 2;
  for (int i = 1; i <= last; ++i) ASSERT_TRUE(get(i).ok());
  EXPECT_EQ(made, last + 1);
  NERITIC_ASSERT_OK(const auto again, get(0));
  EXPECT_EQ(again, used);  // the oldest, but used
  EXPECT_TRUE(get(last).ok());
  EXPECT_EQ(made, last + 1);
  EXPECT_TRUE(get(1).ok());  // the oldest that nobody used is gone
  EXPECT_EQ(made, last + 2);
  EXPECT_FALSE(shelf
                   .get("bad",
                        [] {
                          return Result<PipelineShelf::Made>(Error{ErrorCode::kUnsupported, "no"});
                        })
                   .ok());
  EXPECT_TRUE(
      shelf.get("bad", [] { return Result<PipelineShelf::Made>(std::make_shared<MadePipeline>()); })
          .ok());
}

}  // namespace
}  // namespace neritic::gpu
