// A diver whose eyes a view is: that view sees the body without its head, every other sees it
// whole, in the same frame.
#include <gtest/gtest.h>

#include "engine/core/files.hpp"
#include "testbed/sensors/session.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/support/support.hpp"

namespace neritic::testbed {
namespace {

class WornHead : public test::GpuTest {
 protected:
  void SetUp() override {
    test::GpuTest::SetUp();
    if (IsSkipped()) return;
    const test::ScratchFolder scratch;
    ASSERT_TRUE(write_text(scratch / "s.toml", fmt::format(R"(
[sun]
[[objects]]
name = "diver"
class = "diver"
model = "{}/assets/models/diver.glb"
position_m = [0, -5, 0]
[[cameras]]
name = "front"
position_m = [1.2, -4.7, 2.2]
look_at_m = [0, -4.7, 0]
fov_deg = 50
width = 160
height = 160
)",
                                                           test::source_dir().string()))
                    .ok());
    NERITIC_ASSERT_OK(auto scene, scene::load_scene(scratch / "s.toml"));
    NERITIC_ASSERT_OK(session_, Session::create(device(), std::move(scene)));
  }
  ViewsRequest view(const char* name, bool worn) const {
    const scene::MotionSource motion(session_->scene(), nullptr);
    ViewsRequest out{.name = name,
                     .views = camera_views(motion, session_->scene().cameras[0]),
                     .capture = {.normals = false, .instances = false, .motion = false}};
    if (worn) out.views.worn_object = 0;
    return out;
  }
  FrameResult render(std::vector<ViewsRequest> views) const {
    FrameRequest request;
    request.capture = kColorOnGpu;
    request.capture.to_host = true;
    request.views = std::move(views);
    auto result = session_->render(request);
    EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().message);
    return std::move(result).value();
  }
  std::unique_ptr<Session> session_;
};

TEST_F(WornHead, IsMissingInTheViewOfItsEyesAndThereInEveryOther) {
  const FrameResult whole = render({view("a", false)});
  const FrameResult both = render({view("a", false), view("b", true)});
  const ViewImages& alone = whole.views[0].eyes[0];
  const ViewImages &others = both.views[0].eyes[0], &own = both.views[1].eyes[0];
  EXPECT_EQ(alone.color.data, others.color.data);
  EXPECT_EQ(alone.depth.data, others.depth.data);
  // Rows from the top in which each sees the diver.
  const auto top = [](const ViewImages& seen) {
    std::size_t first = seen.labels.data.size();
    for (std::size_t i = 0; i < seen.labels.data.size(); ++i)
      if (seen.labels.data[i] != 0) first = std::min(first, i);
    return static_cast<double>(first / seen.labels.width);
  };
  const auto pixels = [](const ViewImages& seen) {
    return seen.labels.data.size() -
           static_cast<std::size_t>(std::ranges::count(seen.labels.data, 0));
  };
  // The head and what is worn on it reach 0.25 m over the neck: a pixel is 0.015 m there.
  EXPECT_GT(top(own), top(others) + 10.0);
  EXPECT_LT(top(own), top(others) + 30.0);
  EXPECT_GT(pixels(own), pixels(others) / 2);
  EXPECT_LT(pixels(own) + 150, pixels(others));
  // No pixel is shaded to nonsense where the neck is closed.
  for (const float depth : own.depth.data) EXPECT_TRUE(std::isfinite(depth) || depth > 0.0f);
}

}  // namespace
}  // namespace neritic::testbed
