// The picture of the last frame is there however a run ends.
#include <gtest/gtest.h>

#include "engine/scene/image_file.hpp"
#include "engine/xr/offscreen.hpp"
#include "testbed/loop/loop.hpp"
#include "testbed/view/dive_view.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/xr/ball_scene.hpp"

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

}  // namespace
}  // namespace neritic::testbed
