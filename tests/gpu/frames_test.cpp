// Frames in flight: order of retirement, upload space, timers, failures.
#include "engine/gpu/frames.hpp"

#include <gmock/gmock.h>

#include <array>
#include <cstring>

#include "engine/core/clock.hpp"
#include "engine/gpu/frame_timer.hpp"
#include "engine/gpu/upload_arena.hpp"
#include "shaders.hpp"
#include "tests/support/gpu_fixture.hpp"

namespace neritic::gpu {
namespace {

using ::testing::ElementsAre;

class FramesTest : public test::GpuTest {
 protected:
  // Submits a frame that does nothing.
  static std::uint64_t empty_frame(Frames& frames) {
    EXPECT_TRUE(frames.begin().ok());
    const auto value = frames.submit();
    EXPECT_TRUE(value.ok());
    return value.ok() ? value.value() : 0;
  }
};

TEST_F(FramesTest, ValuesCountUpAndCanBeWaitedFor) {
  NERITIC_ASSERT_OK(const auto frames, Frames::create(device(), 3));
  for (std::uint64_t i = 1; i <= 10; ++i) {
    const std::uint64_t value = empty_frame(*frames);
    EXPECT_EQ(value, i);
    NERITIC_ASSERT_STATUS(frames->wait(value));
  }
  NERITIC_ASSERT_STATUS(frames->wait(1));  // long done
}

TEST_F(FramesTest, RetiredObjectsGoInOrderAndNotBeforeTheirFrame) {
  NERITIC_ASSERT_OK(auto frames, Frames::create(device(), 2));
  std::vector<int> gone;
  ASSERT_TRUE(frames->begin().ok());
  frames->retire([&] { gone.push_back(1); });
  frames->retire([&] { gone.push_back(2); });
  ASSERT_TRUE(frames->submit().ok());          // frame 1
  frames->retire([&] { gone.push_back(3); });  // with frame 1, the last submitted
  EXPECT_THAT(gone, ElementsAre());
  ASSERT_TRUE(frames->begin().ok());  // frame 2: frame 1 may still run
  EXPECT_THAT(gone, ElementsAre());
  frames->retire([&] { gone.push_back(4); });
  ASSERT_TRUE(frames->submit().ok());
  ASSERT_TRUE(frames->begin().ok());  // frame 3 takes frame 1's place, so frame 1 is done
  EXPECT_THAT(gone, ElementsAre(1, 2, 3));
  NERITIC_ASSERT_OK(const std::uint64_t last, frames->submit());
  NERITIC_ASSERT_STATUS(frames->wait(last));
  EXPECT_THAT(gone, ElementsAre(1, 2, 3, 4));
  frames->retire([&, owner = frames.get()] {
    gone.push_back(5);
    owner->retire([&] { gone.push_back(6); });  // an owner that retires what it owned
  });
  frames.reset();
  EXPECT_THAT(gone, ElementsAre(1, 2, 3, 4, 5, 6));
}

TEST_F(FramesTest, AFrameThatWasBegunButNotSubmittedIsDropped) {
  NERITIC_ASSERT_OK(const auto frames, Frames::create(device(), 2));
  ASSERT_TRUE(frames->begin().ok());
  ASSERT_TRUE(frames->begin().ok());
  NERITIC_ASSERT_OK(const std::uint64_t value, frames->submit());
  EXPECT_EQ(value, 1u);
  NERITIC_ASSERT_STATUS(frames->wait(value));
  ASSERT_TRUE(frames->begin().ok());  // and the end drops one, too
}

TEST_F(FramesTest, UploadsOfFramesInFlightDoNotMix) {
  constexpr int kFrames = 8;
  BufferDesc desc;
  desc.name = "results";
  desc.size = 4 * kFrames;
  desc.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  desc.memory = MemoryUse::kReadback;
  NERITIC_ASSERT_OK(const Buffer result, Buffer::create(device(), desc));
  NERITIC_ASSERT_OK(const auto frames, Frames::create(device(), 3));
  std::uint64_t last = 0;
  for (std::uint32_t i = 0; i < kFrames; ++i) {
    NERITIC_ASSERT_OK(Commands * commands, frames->begin());
    const std::uint32_t value = 1000 + i;
    const UploadSlice slice = commands->upload(&value, sizeof value);
    const VkBufferCopy region{slice.offset, 4 * i, 4};
    vkCmdCopyBuffer(commands->handle(), slice.buffer, result.handle(), 1, &region);
    NERITIC_ASSERT_OK(last, frames->submit());
  }
  NERITIC_ASSERT_STATUS(frames->wait(last));
  for (std::uint32_t i = 0; i < kFrames; ++i)
    EXPECT_EQ(result.mapped<std::uint32_t>()[i], 1000 + i);
}

TEST_F(FramesTest, UploadArenasAlignGrowAndThenFit) {
  UploadArena arena(device(), "arena");
  const VkPhysicalDeviceLimits& limits = device().limits();
  std::vector<std::pair<std::byte*, std::size_t>> places;
  for (const std::size_t size : {1u, 100u, 300'000u, 17u, 2'000'000u, 1u}) {
    NERITIC_ASSERT_OK(const UploadArena::Place place, arena.allocate(size));
    EXPECT_EQ(place.offset % 64, 0u);
    EXPECT_EQ(place.offset % limits.minStorageBufferOffsetAlignment, 0u);
    EXPECT_EQ(place.offset % limits.minUniformBufferOffsetAlignment, 0u);
    std::memset(place.mapped, static_cast<int>(places.size()), size);
    places.emplace_back(place.mapped, size);
  }
  for (std::size_t i = 0; i < places.size(); ++i)
    for (std::size_t b = 0; b < places[i].second; ++b)
      ASSERT_EQ(std::to_integer<std::size_t>(places[i].first[b]), i);
  EXPECT_GT(arena.chunk_count(), 1u);
  NERITIC_ASSERT_STATUS(arena.reset());
  for (const std::size_t size : {1u, 100u, 300'000u, 17u, 2'000'000u, 1u})
    ASSERT_TRUE(arena.allocate(size).ok());
  EXPECT_EQ(arena.chunk_count(), 1u) << "a frame like the last allocates nothing";
}

TEST_F(FramesTest, AnUploadThatCannotBeHadFailsTheFrameNotTheProgram) {
  NERITIC_ASSERT_OK(const auto frames, Frames::create(device(), 2));
  NERITIC_ASSERT_OK(Commands * commands, frames->begin());
  const UploadSlice slice = commands->upload(nullptr, VkDeviceSize{1} << 46);
  EXPECT_NE(slice.buffer, VK_NULL_HANDLE);
  const auto submitted = frames->submit();
  ASSERT_FALSE(submitted.ok());
  EXPECT_EQ(submitted.error().code, ErrorCode::kOutOfMemory);
  EXPECT_EQ(empty_frame(*frames), 1u) << "the next frame is fine";
}

// --- Timers -----------------------------------------------------------------------------------

class TimerTest : public FramesTest {
 protected:
  void SetUp() override {
    FramesTest::SetUp();
    if (IsSkipped()) return;
    if (device().timestamp_valid_bits() == 0) GTEST_SKIP() << "the queue has no timestamps";
    ComputePipelineDesc desc;
    desc.name = "burn";
    desc.code = shaders::kTestBurnComp;
    desc.layout.bindings = {{0}};
    desc.layout.push_constant_bytes = 4;
    auto pipeline = Pipeline::create(device(), desc);
    ASSERT_TRUE(pipeline.ok());
    burn_ = std::move(pipeline).value();
    BufferDesc buffer;
    buffer.name = "burned";
    buffer.size = 4 * kInvocations;
    buffer.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    auto made = Buffer::create(device(), buffer);
    ASSERT_TRUE(made.ok());
    values_ = std::move(made).value();
  }
  void TearDown() override {
    burn_ = Pipeline();
    values_ = Buffer();
    FramesTest::TearDown();
  }
  void burn(Commands& commands, std::uint32_t steps) {
    commands.bind_pipeline(burn_);
    commands.bind(burn_, {bound_buffer(0, values_.handle())});
    commands.push(burn_, steps);
    commands.dispatch(kInvocations / 64);
    VkMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
    barrier.srcStageMask = barrier.dstStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    barrier.srcAccessMask = VK_ACCESS_2_SHADER_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_SHADER_READ_BIT | VK_ACCESS_2_SHADER_WRITE_BIT;
    VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    info.memoryBarrierCount = 1;
    info.pMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands.handle(), &info);
  }
  static void clear(VkCommandBuffer commands, const Image& image) {
    VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
    barrier.dstStageMask = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT;
    barrier.newLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    barrier.image = image.handle();
    barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    dependency.imageMemoryBarrierCount = 1;
    dependency.pImageMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands, &dependency);
    VkRenderingAttachmentInfo color{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    color.imageView = image.view();
    color.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    color.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    color.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    VkRenderingInfo info{VK_STRUCTURE_TYPE_RENDERING_INFO};
    info.renderArea = {{0, 0}, {image.desc().width, image.desc().height}};
    info.layerCount = 1;
    info.colorAttachmentCount = 1;
    info.pColorAttachments = &color;
    vkCmdBeginRendering(commands, &info);
    vkCmdEndRendering(commands);
  }
  static constexpr std::uint32_t kInvocations = 64 * 256;
  Pipeline burn_;
  Buffer values_;
};

std::vector<std::string> names_of(const std::vector<PassTime>& times) {
  std::vector<std::string> names;
  for (const PassTime& time : times) names.push_back(time.name);
  return names;
}

TEST(ElapsedTicks, WrapAndAreNeverNegative) {
  constexpr std::uint64_t kBits36 = (1ull << 36) - 1;
  EXPECT_EQ(elapsed_ticks(100, 350, ~0ull), 250u);
  EXPECT_EQ(elapsed_ticks(kBits36 - 9, 5, kBits36), 15u);
  EXPECT_EQ(elapsed_ticks(350, 100, ~0ull), 0u);
  EXPECT_EQ(elapsed_ticks(350, 100, kBits36), 0u);
  EXPECT_EQ(elapsed_ticks(7, 7, ~0ull), 0u);
}

TEST_F(TimerTest, RegionsAreListedInOrderAndTheHeavyOneTakesTheTime) {
  NERITIC_ASSERT_OK(const auto frames, Frames::create(device()));
  EXPECT_TRUE(frames->pass_times().empty());
  const TimeNs start = now_ns();
  NERITIC_ASSERT_OK(Commands * commands, frames->begin());
  commands->begin_region("all");
  commands->begin_region("light");
  burn(*commands, 1);
  commands->end_region();
  commands->begin_region("heavy");
  burn(*commands, 20'000);
  commands->end_region();
  commands->end_region();
  NERITIC_ASSERT_OK(const std::uint64_t frame, frames->submit());
  NERITIC_ASSERT_STATUS(frames->wait(frame));
  const double wall_ms = to_ms(now_ns() - start);
  const auto& times = frames->pass_times();
  ASSERT_THAT(names_of(times), ElementsAre("record", "all", "light", "heavy"));
  for (const PassTime& time : times) {
    EXPECT_GE(time.ms, 0.0) << time.name;
    EXPECT_LE(time.ms, wall_ms) << time.name;
    RecordProperty(time.name + "_us", static_cast<int>(time.ms * 1000));
  }
  EXPECT_GT(times[3].ms, 4 * times[2].ms) << "heavy " << times[3].ms << " light " << times[2].ms;
  EXPECT_GE(times[1].ms * 1.001, times[2].ms + times[3].ms);
  EXPECT_GT(times[1].ms, 0.0);
}

// On lavapipe a dispatch after a rendering took no time at all before FrameTimer knew better.
TEST_F(TimerTest, DispatchesAfterARenderingAreTimedInTheirOwnRegion) {
  ImageDesc desc;
  desc.name = "cleared";
  desc.format = VK_FORMAT_R8G8B8A8_UNORM;
  desc.width = desc.height = 64;
  desc.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  NERITIC_ASSERT_OK(const Image image, Image::create(device(), desc));
  NERITIC_ASSERT_OK(const auto frames, Frames::create(device()));
  NERITIC_ASSERT_OK(Commands * commands, frames->begin());
  commands->begin_region("clear");
  clear(commands->handle(), image);
  commands->end_region();
  for (const auto& [name, steps] : {std::pair{"light", 1u}, {"heavy", 20'000u}, {"last", 1u}}) {
    commands->begin_region(name);
    burn(*commands, steps);
    commands->end_region();
  }
  NERITIC_ASSERT_OK(const std::uint64_t frame, frames->submit());
  NERITIC_ASSERT_STATUS(frames->wait(frame));
  const auto& times = frames->pass_times();
  ASSERT_THAT(names_of(times), ElementsAre("record", "clear", "light", "heavy", "last"));
  EXPECT_GT(times[3].ms, 4 * times[1].ms);
  EXPECT_GT(times[3].ms, 4 * times[2].ms);
  EXPECT_GT(times[3].ms, 4 * times[4].ms);
}

TEST_F(TimerTest, WithTimingOffThereAreNoNewTimes) {
  NERITIC_ASSERT_OK(const auto frames, Frames::create(device()));
  frames->enable_timing(false);
  NERITIC_ASSERT_OK(Commands * commands, frames->begin());
  commands->begin_region("region");
  commands->end_region();
  NERITIC_ASSERT_OK(const std::uint64_t frame, frames->submit());
  NERITIC_ASSERT_STATUS(frames->wait(frame));
  EXPECT_TRUE(frames->pass_times().empty());
}

TEST_F(TimerTest, TimesAreThoseOfTheNewestFinishedFrame) {
  NERITIC_ASSERT_OK(const auto frames, Frames::create(device(), 3));
  std::uint64_t last = 0;
  for (int i = 0; i < 5; ++i) {
    NERITIC_ASSERT_OK(Commands * commands, frames->begin());
    commands->begin_region("frame " + std::to_string(i));
    commands->end_region();
    NERITIC_ASSERT_OK(last, frames->submit());
  }
  NERITIC_ASSERT_STATUS(frames->wait(last));
  EXPECT_THAT(names_of(frames->pass_times()), ElementsAre("record", "frame 4"));
  NERITIC_ASSERT_STATUS(frames->wait(last - 1));
  EXPECT_THAT(names_of(frames->pass_times()), ElementsAre("record", "frame 4"));
}

TEST_F(TimerTest, TimesOfAFrameStayUntilItsSlotIsDoneAgain) {
  NERITIC_ASSERT_OK(const auto frames, Frames::create(device(), 2));
  std::uint64_t done[4] = {};
  const auto submit = [&](int i) {
    NERITIC_ASSERT_OK(Commands * commands, frames->begin());
    commands->begin_region("frame " + std::to_string(i));
    commands->end_region();
    NERITIC_ASSERT_OK(done[i], frames->submit());
  };
  submit(0);
  submit(1);
  NERITIC_ASSERT_STATUS(frames->wait(done[1]));
  EXPECT_THAT(names_of(frames->pass_times_of(done[0])), ElementsAre("record", "frame 0"));
  EXPECT_THAT(names_of(frames->pass_times_of(done[1])), ElementsAre("record", "frame 1"));
  submit(2);
  submit(3);
  NERITIC_ASSERT_STATUS(frames->wait(done[3]));
  EXPECT_TRUE(frames->pass_times_of(done[0]).empty());
  EXPECT_THAT(names_of(frames->pass_times_of(done[2])), ElementsAre("record", "frame 2"));
}

TEST_F(TimerTest, CompletedIsTheNewestFrameThatIsDone) {
  NERITIC_ASSERT_OK(const auto frames, Frames::create(device(), 2));
  NERITIC_ASSERT_OK(const std::uint64_t none, frames->completed());
  EXPECT_EQ(none, 0u);
  for (int i = 0; i < 3; ++i) {
    NERITIC_ASSERT_OK(Commands * commands, frames->begin());
    burn(*commands, 1);
    NERITIC_ASSERT_OK(const std::uint64_t frame, frames->submit());
    NERITIC_ASSERT_OK(const std::uint64_t before, frames->completed());
    EXPECT_LE(before, frame);
    NERITIC_ASSERT_STATUS(frames->wait(frame));
    NERITIC_ASSERT_OK(const std::uint64_t after, frames->completed());
    EXPECT_EQ(after, frame);
  }
}

TEST_F(TimerTest, RegionsBeyondTheLimitAreNotTimedAndHarmNothing) {
  NERITIC_ASSERT_OK(const auto frames, Frames::create(device()));
  NERITIC_ASSERT_OK(Commands * commands, frames->begin());
  commands->begin_region("outer");
  for (int i = 0; i < 300; ++i) {
    commands->begin_region("inner");
    commands->end_region();
  }
  commands->end_region();
  NERITIC_ASSERT_OK(const std::uint64_t frame, frames->submit());
  NERITIC_ASSERT_STATUS(frames->wait(frame));
  EXPECT_EQ(frames->pass_times().size(), 257u);
  EXPECT_EQ(frames->pass_times()[1].name, "outer");
}

}  // namespace
}  // namespace neritic::gpu
