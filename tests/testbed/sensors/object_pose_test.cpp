// Objects that devices move, in pictures and echoes: a camera sees it where it was measured, and a
// sonar on it hears from there, at its velocity.
#include <gtest/gtest.h>

#include "engine/core/files.hpp"
#include "testbed/motion/live_physics.hpp"
#include "testbed/sensors/session.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/support/support.hpp"

namespace neritic::testbed {
namespace {

class ObjectPoseSeen : public test::GpuTest {};

constexpr double kMeasured_s = 1.0, kBoat_m_s = 3.0;

// A wall at z = -5; a boat that comes towards it with a sonar and an eye that looks at a ball on
// its bow; boat: its motion.
scene::Scene boat_scene(const std::string& boat) {
  const test::ScratchFolder scratch;
  EXPECT_TRUE(write_text(scratch / "s.toml", R"([physics]
[sun]
[[objects]]
name = "wall"
class = "structure"
shape = "box"
size_m = [40, 20, 1]
position_m = [0, -10, -5.5]
[[objects]]
name = "boat"
)" + boat + R"(
[[objects.sonars]]
name = "sonar"
range_m = [0.5, 12]
azimuth_deg = 40
elevation_deg = 10
bins = [800, 64, 32]
frequency_hz = 750000
range_spread = { bandwidth_hz = 60000 }
motion = { within_ping = true, doppler = true, pulse_s = 0.0005 }
[[objects]]
name = "ball"
class = "target"
shape = "sphere"
radius_m = 0.3
on = "boat"
position_m = [0.5, 0.2, 1.0]
[[cameras]]
name = "eye"
position_m = [0, -8, 8]
look_at_m = [0, -10, 0]
width = 160
height = 90
)")
                  .ok());
  auto scene = scene::load_scene(scratch / "s.toml");
  EXPECT_TRUE(scene.ok()) << scene.error().message;
  return std::move(scene).value();
}

FrameResult rendered_at(gpu::Device& device, const scene::Scene& scene, double time_s,
                        const scene::SimulatedMotion* simulated) {
  FrameRequest request;
  request.time_s = time_s;
  request.next_time_s = time_s + 0.01;
  request.cameras = {0};
  request.sonars = {0};
  request.simulated = simulated;
  auto session = Session::create(device, scene);
  EXPECT_TRUE(session.ok());
  auto result = (*session)->render(request);
  EXPECT_TRUE(result.ok()) << result.error().message;
  return std::move(result).value();
}

double echo_difference(const SonarFrame& a, const SonarFrame& b) {
  double sum = 0.0, all = 0.0;
  for (std::size_t i = 0; i < a.image.intensity.size(); ++i) {
    sum += std::abs(double(a.image.intensity[i]) - double(b.image.intensity[i]));
    all += b.image.intensity[i];
  }
  return sum / all;
}

TEST_F(ObjectPoseSeen, ACameraSeesItWhereItWasMeasuredAndItsSonarHearsItsVelocity) {
  const scene::Scene scene = boat_scene("inputs = { pose = \"gnss\" }");
  NERITIC_ASSERT_OK(const auto live, LivePhysics::create(scene, LivePhysics::Pace::kPicture));
  SampleInbox& inbox = live->inbox();
  NERITIC_ASSERT_OK(const SourceId source, inbox.open("gnss"));
  const StreamId stream = live->world().streams().find("boat/pose").value();
  // On its way to [0, -10, -1] at kMeasured_s; 60 poses a second.
  for (std::uint64_t i = 0; i <= 61; ++i) {
    const double t = static_cast<double>(i) / 60.0;
    live->follow(0, t);
    const TimeNs now = std::llround(1e9 * t);
    const Pose pose{{0.0, -10.0, -1.0 + kBoat_m_s * (kMeasured_s - t)}, Quat(1, 0, 0, 0)};
    ASSERT_EQ(inbox.push({{stream, source, i, now, now}, ObjectPose{.world_from_object = pose}}),
              SampleVerdict::kAccepted);
  }
  const FrameResult measured = rendered_at(device(), scene, kMeasured_s, &live->motion());

  const FrameResult tracked =
      rendered_at(device(),
                  boat_scene("track = { waypoints_m = [[0, -10, 2], [0, -10, -4]], speed_m_s = 3, "
                             "heading = \"fixed\" }"),
                  kMeasured_s, nullptr);
  const FrameResult still =
      rendered_at(device(),
                  boat_scene("track = { waypoints_m = [[0, -10, -1], [0, -10, -4]], "
                             "speed_m_s = 3, start_s = 2, heading = \"fixed\" }"),
                  kMeasured_s, nullptr);
  const ViewImages &a = measured.cameras[0].eyes[0], &b = tracked.cameras[0].eyes[0];
  EXPECT_EQ(a.labels.data, b.labels.data);
  EXPECT_GT(std::ranges::count(a.labels.data, 12), 20);
  ASSERT_EQ(a.motion.data.size(), b.motion.data.size());
  double worst_px = 0.0, most_px = 0.0;
  for (std::size_t i = 0; i < a.motion.data.size(); ++i) {
    worst_px = std::max(worst_px, std::abs(double(a.motion.data[i]) - double(b.motion.data[i])));
    most_px = std::max(most_px, std::abs(double(b.motion.data[i])));
  }
  EXPECT_LT(worst_px, 1e-3);
  EXPECT_GT(most_px, 0.05);

  const SonarFrame& heard = measured.sonars[0];
  EXPECT_LT(glm::distance(heard.world_from_sonar.position_m, Vec3(0, -10, -1)), 1e-8);
  EXPECT_LT(echo_difference(heard, tracked.sonars[0]), 1e-3);
  EXPECT_GT(echo_difference(heard, still.sonars[0]), 0.01);
}

}  // namespace
}  // namespace neritic::testbed
