// Frames that the caller runs: two in flight and several consumers at rates of their own never see
// each other's results, nothing leaves the GPU unasked, and views need no camera of the scene.
#include <gmock/gmock.h>

#include "tests/testbed/sensors/sonar_sea.hpp"

namespace neritic::testbed {
namespace {

using ::testing::HasSubstr;

// Every term with ghosts and labels by energy, the plain cosine, and a camera; all ride on a track.
scene::Scene sea_with_camera() {
  scene::Sonar every = small_sonar();
  every.terms = every_term();
  scene::Scene scene = some_sea(every);
  scene::Sonar plain = small_sonar();
  plain.name = "plain";
  plain.mount = scene.sonars[0].mount;
  scene.sonars.push_back(plain);
  scene.sun = scene::Sun{};
  scene::Camera camera;
  camera.name = "camera";
  camera.width = 101;
  camera.height = 67;
  camera.mount = scene.sonars[0].mount;
  scene.cameras = {camera};
  return scene;
}

FrameRequest all_at(double time_s, std::uint32_t ping) {
  FrameRequest request;
  request.time_s = time_s;
  request.next_time_s = time_s + 0.1;
  request.cameras = {0};
  request.sonars = {0, 1};
  request.pings = {ping, ping + 3};
  return request;
}

void expect_same(const ViewImages& a, const ViewImages& b) {
  EXPECT_EQ(a.color.data, b.color.data);
  EXPECT_EQ(a.depth.data, b.depth.data);
  EXPECT_EQ(a.normals.data, b.normals.data);
  EXPECT_EQ(a.labels.data, b.labels.data);
  EXPECT_EQ(a.instances.data, b.instances.data);
  EXPECT_EQ(a.motion.data, b.motion.data);
}

void expect_same(const FrameResult& a, const FrameResult& b) {
  ASSERT_EQ(a.cameras.size(), b.cameras.size());
  for (std::size_t i = 0; i < a.cameras.size(); ++i)
    expect_same(a.cameras[i].eyes.at(0), b.cameras[i].eyes.at(0));
  ASSERT_EQ(a.sonars.size(), b.sonars.size());
  for (std::size_t i = 0; i < a.sonars.size(); ++i) {
    const SonarFrame &x = a.sonars[i], &y = b.sonars[i];
    EXPECT_EQ(x.image.intensity, y.image.intensity) << x.name;
    EXPECT_EQ(x.image.labels, y.image.labels) << x.name;
    ASSERT_EQ(x.label_energy.has_value(), y.label_energy.has_value());
    if (x.label_energy) {
      EXPECT_EQ(x.label_energy->classes, y.label_energy->classes);
      EXPECT_EQ(x.label_energy->fraction, y.label_energy->fraction);
    }
    ASSERT_EQ(x.sectors.size(), y.sectors.size());
    for (std::size_t s = 0; s < x.sectors.size(); ++s) expect_same(x.sectors[s], y.sectors[s]);
  }
}

class SensorFrameTest : public test::GpuTest {
 protected:
  // A frame that is declared and submitted; nobody has waited for it.
  static Result<std::unique_ptr<SensorFrame>> submit(Session& session,
                                                     const FrameRequest& request) {
    graph::FrameGraph graph;
    NERITIC_TRY(auto frame, session.declare(graph, request));
    NERITIC_TRY_STATUS(run(session, graph, *frame));
    return frame;
  }
  static Status run(Session& session, graph::FrameGraph& graph, SensorFrame& frame) {
    NERITIC_TRY(gpu::Commands * commands, session.frames().begin());
    NERITIC_TRY([[maybe_unused]] const graph::Plan* plan, session.executor().run(graph, *commands));
    NERITIC_TRY(const std::uint64_t done, session.frames().submit());
    frame.submitted(done);
    return {};
  }
  static Result<FrameResult> wait_and_read(Session& session, const SensorFrame& frame) {
    NERITIC_TRY_STATUS(session.frames().wait(frame.done_at()));
    return session.read(frame);
  }
  // The same by a session of its own.
  FrameResult alone(const FrameRequest& request) {
    auto session = Session::create(device(), sea_with_camera());
    auto result = (*session)->render(request);
    EXPECT_TRUE(result.ok()) << result.error().message;
    return std::move(*result);
  }
};

TEST_F(SensorFrameTest, TwoFramesInFlightGiveTheBitsOfSingleFrames) {
  const FrameRequest first = all_at(-0.5, 1), second = all_at(0.5, 2);
  NERITIC_ASSERT_OK(const auto session, Session::create(device(), sea_with_camera()));
  // Both are declared before the first is recorded, and submitted before the first is read.
  graph::FrameGraph first_graph, second_graph;
  NERITIC_ASSERT_OK(const auto a, session->declare(first_graph, first));
  NERITIC_ASSERT_OK(const auto b, session->declare(second_graph, second));
  NERITIC_ASSERT_STATUS(run(*session, first_graph, *a));
  NERITIC_ASSERT_STATUS(run(*session, second_graph, *b));
  NERITIC_ASSERT_OK(const FrameResult newer, wait_and_read(*session, *b));
  NERITIC_ASSERT_OK(const bool done, session->is_done(*a));
  ASSERT_TRUE(done);
  NERITIC_ASSERT_OK(const FrameResult older, session->read(*a));
  EXPECT_NE(older.sonars[0].image.intensity, newer.sonars[0].image.intensity);
  EXPECT_NE(older.cameras[0].eyes[0].color.data, newer.cameras[0].eyes[0].color.data);
  {
    SCOPED_TRACE("older");
    expect_same(older, alone(first));
  }
  SCOPED_TRACE("newer");
  expect_same(newer, alone(second));
  EXPECT_EQ(older.passes.size(), newer.passes.size());
  EXPECT_GT(older.passes.size(), 1u);
}

// A slow consumer keeps a frame while a quick one reads the next ones and lets them go.
TEST_F(SensorFrameTest, AFrameKeepsItsResultsWhileOthersComeAndGo) {
  const FrameRequest kept = all_at(0.25, 7);
  NERITIC_ASSERT_OK(const auto session, Session::create(device(), sea_with_camera()));
  NERITIC_ASSERT_OK(const auto frame, submit(*session, kept));
  for (std::uint32_t i = 0; i < 5; ++i) {
    const FrameRequest request = all_at(-0.6 + 0.1 * i, i);
    NERITIC_ASSERT_OK(const auto other, submit(*session, request));
    NERITIC_ASSERT_OK(const FrameResult result, wait_and_read(*session, *other));
    if (i == 4) expect_same(result, alone(request));
  }
  NERITIC_ASSERT_OK(const FrameResult result, session->read(*frame));
  expect_same(result, alone(kept));
}

TEST_F(SensorFrameTest, TheRingSaysThatTooManyFramesHoldReadBacks) {
  FrameRequest request;
  request.sonars = {1};
  request.capture = request.capture.without_geometry();
  NERITIC_ASSERT_OK(const auto session, Session::create(device(), sea_with_camera()));
  std::vector<std::unique_ptr<SensorFrame>> held;
  for (std::size_t i = 0; i < Ring<gpu::Buffer>::kMost; ++i) {
    NERITIC_ASSERT_OK(auto frame, submit(*session, request));
    held.push_back(std::move(frame));
  }
  {
    graph::FrameGraph graph;
    const auto refused = session->declare(graph, request);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().message,
              "test: sonar plain: read-back: found 8 frames that hold one; accepted: at most 8 "
              "frames at once");
  }
  held.erase(held.begin());
  NERITIC_ASSERT_OK(const FrameResult result, session->render(request));
  EXPECT_GT(total(result.sonars[0]), 0.0);
}

TEST_F(SensorFrameTest, NewSettingsDoNotTouchAFrameInFlight) {
  const FrameRequest request = all_at(0.0, 1);
  NERITIC_ASSERT_OK(const auto session, Session::create(device(), sea_with_camera()));
  graph::FrameGraph graph;
  NERITIC_ASSERT_OK(const auto frame, session->declare(graph, request));
  scene::Sonar sonar = session->scene().sonars[1];
  sonar.bins_range = 60;
  session->replace_sonar(1, sonar);
  NERITIC_ASSERT_OK(const FrameResult changed, session->render(request));
  EXPECT_EQ(changed.sonars[1].image.n_range, 60u);
  NERITIC_ASSERT_STATUS(run(*session, graph, *frame));
  NERITIC_ASSERT_OK(const FrameResult result, wait_and_read(*session, *frame));
  expect_same(result, alone(request));
}

TEST_F(SensorFrameTest, AViewSetShowsWhatACameraThereShows) {
  NERITIC_ASSERT_OK(const auto session, Session::create(device(), sea_with_camera()));
  const scene::Camera& camera = session->scene().cameras[0];
  FrameRequest request = all_at(0.3, 1);
  request.sonars.clear();
  request.pings.clear();
  request.views = {
      {.name = "window",
       .views = camera_views(session->scene(), camera, request.time_s, request.next_time_s),
       .exposure = camera.exposure,
       .antialias = camera.antialias,
       .capture = {}}};
  NERITIC_ASSERT_OK(const FrameResult both, session->render(request));
  ASSERT_EQ(both.views.size(), 1u);
  EXPECT_EQ(both.views[0].name, "window");
  expect_same(both.cameras[0].eyes[0], both.views[0].eyes.at(0));
  EXPECT_GT(std::ranges::count(both.views[0].eyes[0].labels.data, 12), 0);
}

// The request of a window: colour and depth for passes of the same graph, no copies.
TEST_F(SensorFrameTest, NothingLeavesTheGpuUnasked) {
  NERITIC_ASSERT_OK(const auto session, Session::create(device(), sea_with_camera()));
  FrameRequest request = all_at(0.0, 0);
  request.cameras.clear();
  request.capture = kColorOnGpu;
  ViewsRequest eyes{.name = "eyes"};
  eyes.views.width = 64;
  eyes.views.height = 48;
  for (const double x_m : {-0.03, 0.03})
    eyes.views.views.push_back({.world_from_view = Pose{Vec3(x_m, -4.0, 1.0)},
                                .tangents = tangents_from_fov(radians(80.0), 64.0 / 48.0),
                                .near_m = 0.1});
  request.views = {eyes};
  graph::FrameGraph graph;
  NERITIC_ASSERT_OK(const auto frame, session->declare(graph, request));
  ASSERT_EQ(frame->views.size(), 1u);
  const SensorFrame::Views& views = frame->views[0];
  EXPECT_EQ(views.layers, 2u);
  EXPECT_EQ(views.near_m, 0.1);
  EXPECT_TRUE(views.color && views.depth);
  EXPECT_EQ(frame->sonars.size(), 2u);
  EXPECT_TRUE(graph.declaration().outputs.empty());
  for (const auto& pass : graph.declaration().passes) {
    EXPECT_THAT(pass.name, ::testing::Not(HasSubstr("readback")));
    EXPECT_THAT(pass.name, ::testing::Not(HasSubstr("to host")));
  }
  // A consumer of the depth finds the sphere's front where it is, 5 m before the eyes.
  ReadbackPool readback;
  NERITIC_ASSERT_OK(const Readback depth,
                    readback.declare(graph, device(), "depth", views.depth, render::kDepthFormat,
                                     views.width, views.height, views.layers));
  NERITIC_ASSERT_STATUS(run(*session, graph, *frame));
  NERITIC_ASSERT_STATUS(session->frames().wait(frame->done_at()));
  const std::size_t middle = std::size_t{24} * 64 + 34;  // 0.44 m to starboard at 5 m
  for (const std::size_t eye : {0u, 1u}) {
    const double planar_m = views.near_m / depth->mapped<float>()[eye * 64 * 48 + middle];
    EXPECT_NEAR(planar_m, 5.0, 0.1);
  }
  NERITIC_ASSERT_OK(const FrameResult nothing, session->read(*frame));
  EXPECT_TRUE(nothing.views.empty() && nothing.sonars.empty());
}

}  // namespace
}  // namespace neritic::testbed
