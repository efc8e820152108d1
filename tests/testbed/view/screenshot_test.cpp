// The picture of the last frame is there however a run ends.
#include <gtest/gtest.h>

#include "engine/scene/image_file.hpp"
#include "engine/xr/offscreen.hpp"
#include "testbed/loop/loop.hpp"
#include "testbed/view/dive_view.hpp"
#include "testbed/view/screenshots.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/xr/ball_scene.hpp"
#include "tests/xr/shown.hpp"

namespace neritic::testbed {
namespace {

class Screenshot : public test::GpuTest {};

TEST_F(Screenshot, AnInterruptedRunLeavesThePictureOfItsLastFrame) {
  const test::ScratchFolder scratch;
  NERITIC_ASSERT_OK(const auto session,
                    Session::create(device(), xr::ball_scene("[[cameras]]\nname = \"eye\"\n")));
  NERITIC_ASSERT_OK(const auto display, xr::OffscreenDisplay::create(
                                            device(), {{xr::one_view(48, 32, radians(60.0))}}));
  NERITIC_ASSERT_OK(const auto view, DiveView::create(*session, *display, nullptr, nullptr,
                                                      {.screenshot = scratch / "last.png"}));
  int asked = 0;
  Loop loop({.clock = Clock::simulated(0.0, 0.1),
             .sensors = LoopSensors{.session = session.get(), .capture = kColorOnGpu},
             .view = view.get(),
             .stop = {.interrupted = [&] { return ++asked > 6; }}});
  NERITIC_ASSERT_STATUS(loop.run());
  EXPECT_TRUE(loop.interrupted());
  EXPECT_GT(loop.frames(), 0u);
  NERITIC_ASSERT_OK(const ImageU8 image, scene::read_image8(scratch / "last.png", 3));
  EXPECT_EQ(image.width, 48u);
}

// As on a full disk or in a folder that takes no file: here one that is gone.
TEST_F(Screenshot, OneByKeyThatCannotBeWrittenIsANoteAndNoError) {
  const auto was = std::filesystem::current_path();
  NERITIC_ASSERT_OK(const auto frames, gpu::Frames::create(device(), 1));
  NERITIC_ASSERT_OK(const auto display,
                    xr::OffscreenDisplay::create(device(), {{xr::one_view(8, 8, radians(60.0))}}));
  Screenshots shots(device(), *frames, {});
  std::optional<std::string> note;
  Status written;
  {
    const test::ScratchFolder gone;
    std::filesystem::current_path(gone.path());
    std::filesystem::remove_all(gone.path());
    graph::FrameGraph graph;
    const std::vector<xr::Layer> layers{
        xr::PanelLayer{.name = "red",
                       .image = xr::flat_image(graph, "red", 8, 8, {{1, 0, 0, 1}}),
                       .pose = Pose{{0, 0, -1}},
                       .size_m = {2.0, 2.0}}};
    NERITIC_ASSERT_OK(const xr::ShownPicture shown, display->declare(graph, {}, layers));
    shots.ask();
    NERITIC_ASSERT_STATUS(shots.declare(graph, shown, false));
    graph::Executor executor(*frames);
    NERITIC_ASSERT_OK(gpu::Commands* const commands, frames->begin());
    NERITIC_ASSERT_OK([[maybe_unused]] const auto plan, executor.run(graph, *commands));
    NERITIC_ASSERT_OK(const std::uint64_t value, frames->submit());
    shots.submitted(value);
    NERITIC_ASSERT_STATUS(frames->wait(value));
    written = shots.write_done(value);
    note = shots.take_note();
    std::filesystem::current_path(was);
  }
  EXPECT_TRUE(written.ok()) << written.error().message;
  EXPECT_TRUE(note && note->starts_with("no screenshot: neritic_0001.png")) << note.value_or("");
  NERITIC_ASSERT_STATUS(shots.finish());
}

}  // namespace
}  // namespace neritic::testbed
