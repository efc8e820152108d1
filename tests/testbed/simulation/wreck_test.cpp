// The default mission round the wreck, and vehicles driven into it: an oracle of its own counts the
// wreck's triangles that come into the vehicle's parts.
#include <algorithm>

#include "engine/scene/animation.hpp"
#include "tests/testbed/simulation/senders.hpp"

namespace neritic::testbed {
namespace {

using Corners = std::array<Vec3, 3>;

// The triangles of an object as it stands, by the scene's own transforms.
std::vector<Corners> triangles_of(const scene::Scene& scene, const std::string& name) {
  std::vector<Corners> out;
  for (const scene::Object& object : scene.objects) {
    if (object.name != name) continue;
    const scene::Model& model = *scene.models[static_cast<std::size_t>(object.model)];
    const auto pose = scene::evaluate_pose(model, -1, 0.0);
    const Mat4 world_from_model = scene.world_from_copy(object, 0);
    for (std::size_t n = 0; n < model.nodes.size(); ++n) {
      if (model.nodes[n].mesh < 0) continue;
      const Mat4 m = world_from_model * pose.model_from_node[n];
      for (const auto& p : model.meshes[static_cast<std::size_t>(model.nodes[n].mesh)].primitives)
        for (std::size_t i = 0; i + 2 < p.indices.size(); i += 3) {
          Corners corners;
          for (std::size_t k = 0; k < 3; ++k)
            corners[k] = Vec3(m * Vec4(Vec3(p.positions[p.indices[i + k]]), 1.0));
          out.push_back(corners);
        }
    }
  }
  return out;
}

// Whether a triangle meets the box [-half, half]: no axis of Akenine-Moller's (2001) thirteen
// separates them.
bool meets_box(const Corners& t, const Vec3& half) {
  const auto separates = [&](const Vec3& axis) {
    const double a = glm::dot(axis, t[0]), b = glm::dot(axis, t[1]), c = glm::dot(axis, t[2]);
    const double reach = glm::dot(glm::abs(axis), half);
    return std::min({a, b, c}) > reach || std::max({a, b, c}) < -reach;
  };
  const Vec3 edges[] = {t[1] - t[0], t[2] - t[1], t[0] - t[2]};
  if (separates(glm::cross(edges[0], edges[1]))) return false;
  for (int i = 0; i < 3; ++i) {
    Vec3 unit(0.0);
    unit[i] = 1.0;
    if (separates(unit)) return false;
    for (const Vec3& edge : edges)
      if (separates(glm::cross(unit, edge))) return false;
  }
  return true;
}

// Says how many triangles are in the boxes about a vehicle's parts.
class Oracle {
 public:
  Oracle(const scene::Scene& scene, const std::string& solid) {
    for (const Corners& t : triangles_of(scene, solid))
      triangles_.push_back(
          {t, glm::min(t[0], glm::min(t[1], t[2])), glm::max(t[0], glm::max(t[1], t[2]))});
    EXPECT_GT(triangles_.size(), 10000u);
  }
  // The boxes made smaller by this margin all round.
  std::size_t inside(const sim::BodyShape& shape, const Pose& world_from_body,
                     double smaller_m) const {
    std::size_t count = 0;
    for (const sim::ConvexPart& part : shape.parts()) {
      const Vec3 middle = part.centre_m + part.axes * (0.5 * (part.low_m + part.high_m));
      count += inside_box(world_from_body * Pose{middle, glm::quat_cast(part.axes)},
                          0.5 * (part.high_m - part.low_m) - Vec3(smaller_m));
    }
    return count;
  }
  std::size_t inside_box(const Pose& world_from_box, const Vec3& half) const {
    const Pose box_from_world = inverse(world_from_box);
    const Vec3 centre = world_from_box.position_m;
    const double reach = glm::length(half);
    std::size_t count = 0;
    for (const Triangle& t : around(centre, reach)) {
      if (!t.within(centre, reach)) continue;
      const Corners local{box_from_world * t.corners[0], box_from_world * t.corners[1],
                          box_from_world * t.corners[2]};
      if (meets_box(local, half)) ++count;
    }
    return count;
  }

 private:
  struct Triangle {
    Corners corners;
    Vec3 low, high;

    bool within(const Vec3& centre, double reach) const {
      return low.x < centre.x + reach && high.x > centre.x - reach && low.y < centre.y + reach &&
             high.y > centre.y - reach && low.z < centre.z + reach && high.z > centre.z - reach;
    }
  };

  // All triangles within reach of a place, and some more: they serve until the place has moved.
  const std::vector<Triangle>& around(const Vec3& centre, double reach) const {
    constexpr double kMoved_m = 1.0, kReach_m = 2.0;
    if (reach <= reach_m_ && glm::distance(centre, about_m_) <= kMoved_m) return near_;
    about_m_ = centre;
    reach_m_ = std::max(reach, kReach_m);
    near_.clear();
    for (const Triangle& t : triangles_)
      if (t.within(centre, reach_m_ + kMoved_m)) near_.push_back(t);
    return near_;
  }

  std::vector<Triangle> triangles_;
  mutable std::vector<Triangle> near_;
  mutable Vec3 about_m_{0.0};
  mutable double reach_m_ = -1.0;
};

const Oracle& wreck_oracle() {
  static const Oracle oracle(mission_scene(), "submarine");
  return oracle;
}

TEST(WreckMission, AllWaypointsAreReachedAndNothingIsTouched) {
  TestDive dive = dive_of(mission_scene());
  EXPECT_GT(wreck_oracle().inside_box({{0.0, -15.0, 0.0}, Quat(1, 0, 0, 0)}, Vec3(2.0)), 0u);
  const sim::BodyShape& shape = dive.world->vehicles()[0].kind.solid.shape;
  EXPECT_GT(shape.parts().size(), 1u);
  dive.run(230.0, [&] {
    if (dive.simulation->newest().step % 24 == 0) {
      ASSERT_EQ(wreck_oracle().inside(shape, dive.pose(), -0.5), 0u)
          << dive.time_s();  // half a metre off
    }
  });
  const auto& vehicle = dive.world->vehicles()[0];
  EXPECT_EQ(dive.vehicle().mission.arrived, vehicle.mission->waypoint_count());
  EXPECT_EQ(vehicle.mission->waypoint_count(), 9u);
  EXPECT_TRUE(vehicle.mission->done(dive.vehicle().mission));
  EXPECT_EQ(dive.vehicle().contact.touched_steps, 0u);
  EXPECT_EQ(dive.vehicle().body.refused_inputs, 0u);
}

// A hundred kilometres away it flies the same way, to what doubles hold there.
TEST(WreckMission, FarFromTheOriginItFliesTheSame) {
  const Vec3 offset(1e5, 0.0, -7e4);
  auto far = scene::load_scene(test::source_dir() / "assets/scenes/mission.toml", {offset});
  ASSERT_TRUE(far.ok());
  TestDive here = dive_of(mission_scene()), there = dive_of(std::move(far).value());
  double apart_m = 0.0;
  here.run(40.0, [&] {
    there.simulation->advance(1);
    apart_m =
        std::max(apart_m, glm::distance(there.pose().position_m, here.pose().position_m + offset));
  });
  EXPECT_LT(apart_m, 1e-6);
  EXPECT_EQ(there.vehicle().mission.arrived, here.vehicle().mission.arrived);
}

struct Ram {
  Vec3 from_m;
  double yaw_deg;
  rov::Vec6 thrust;
  double seconds = 30.0;
};

void expect_to_stay_outside(scene::Scene scene, const Ram& ram) {
  scene::Object& rov = *std::ranges::find(scene.objects, "rov", &scene::Object::name);
  rov.mount.pose = {ram.from_m, from_yaw_pitch_roll(radians(ram.yaw_deg), 0.0, 0.0)};
  TestDive dive = dive_of(std::move(scene));
  Piloting inputs;
  inputs.piloted = 1;
  inputs.pilot = ram.thrust;
  pilot(dive, 0, inputs);
  const sim::BodyShape& shape = dive.world->vehicles()[0].kind.solid.shape;
  dive.run(test::is_thorough() ? 60.0 : ram.seconds, [&] {
    if (dive.simulation->newest().step % 12 == 0) {
      ASSERT_EQ(wreck_oracle().inside(shape, dive.pose(), 0.006), 0u) << dive.time_s();
    }
  });
  EXPECT_GT(dive.vehicle().contact.touched_steps, 1000u);
  EXPECT_LT(dive.vehicle().contact.deepest_m, 0.006);
}

// At full thrust against the wreck's flank, deck and bow for half a minute or one each: never more
// than a few millimetres of the vehicle's parts in any of its triangles.
TEST(WreckRamming, NobodyGetsIntoTheWreck) {
  rov::Vec6 ahead, down, ahead_and_down, astern_and_up;
  ahead[0] = 400.0;
  down[2] = 400.0;
  ahead_and_down[0] = ahead_and_down[2] = 300.0;
  astern_and_up[0] = -200.0, astern_and_up[1] = 150.0, astern_and_up[5] = 5.0;
  const Ram rams[] = {{{6.0, -15.5, 6.0}, 90.0, ahead},                   // the flank, to port
                      {{-6.0, -15.0, 10.0}, -90.0, ahead},                // the other
                      {{0.5, -10.0, 8.0}, 0.0, down},                     // the deck
                      {{4.5, -12.0, -11.0}, 90.0, ahead_and_down},        // the torn side
                      {{-1.0, -15.5, 30.0}, 0.0, ahead},                  // the stern
                      {{-6.0, -15.0, -3.0}, 90.0, astern_and_up, 60.0}};  // in a curve
  const scene::Scene scene = mission_scene();
  for (const Ram& ram : rams) {
    SCOPED_TRACE(fmt::format("from {} {} {}", ram.from_m.x, ram.from_m.y, ram.from_m.z));
    expect_to_stay_outside(scene, ram);
  }
}

// Five metres a second of water press it against the flank and along it.
TEST(WreckMission, NoCurrentPushesItIntoTheWreck) {
  scene::Scene scene = mission_scene();
  scene.current =
      scene::Current{.kind = scene::Current::Kind::kUniform, .velocity_m_s = Vec3(-5.0, 0.0, 0.3)};
  scene::Object& rov = *std::ranges::find(scene.objects, "rov", &scene::Object::name);
  rov.mount.pose = {{6.0, -15.5, 6.0}, from_yaw_pitch_roll(radians(20.0), 0.0, 0.0)};
  TestDive dive = dive_of(std::move(scene));
  const sim::BodyShape& shape = dive.world->vehicles()[0].kind.solid.shape;
  dive.run(20.0, [&] {
    ASSERT_LT(dive.speed_m_s(), 6.0);
    if (dive.simulation->newest().step % 12 == 0) {
      ASSERT_EQ(wreck_oracle().inside(shape, dive.pose(), 0.006), 0u) << dive.time_s();
    }
  });
  EXPECT_GT(dive.vehicle().contact.touched_steps, 100u);
  EXPECT_LT(dive.vehicle().contact.deepest_m, 0.006);
  EXPECT_EQ(dive.simulation->refused_states(), 0u);
}

TEST(WreckMission, DroppedOnSandItComesToRest) {
  scene::Scene scene = mission_scene();
  scene.physics->water_kg_m3 = 990.0;  // so that it sinks, with 2.3 N
  scene.current.reset();
  scene::Object& rov = *std::ranges::find(scene.objects, "rov", &scene::Object::name);
  rov.dynamics->mission.reset();
  rov.mount.pose = {{9.0, -16.5, 4.0}, from_yaw_pitch_roll(0.3, 0.2, 0.25)};
  TestDive dive = dive_of(std::move(scene));
  dive.run(90.0);
  const Pose rest = dive.pose();
  EXPECT_LT(rest.position_m.y, -17.0);
  double fastest_m_s = 0.0, farthest_m = 0.0;
  dive.run(10.0, [&] {
    fastest_m_s = std::max(fastest_m_s, dive.speed_m_s());
    farthest_m = std::max(farthest_m, glm::distance(dive.pose().position_m, rest.position_m));
  });
  EXPECT_LT(fastest_m_s, 1e-3);
  EXPECT_LT(farthest_m, 1e-3);
  EXPECT_LT(dive.vehicle().contact.deepest_m, 0.005);
  const Oracle sand(dive.scene, "seabed");
  const sim::BodyShape& shape = dive.world->vehicles()[0].kind.solid.shape;
  EXPECT_EQ(sand.inside(shape, dive.pose(), 0.006), 0u);
  EXPECT_GT(sand.inside(shape, dive.pose(), -0.006), 0u);
}

}  // namespace
}  // namespace neritic::testbed
