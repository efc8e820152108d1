// Reads and checks divers once (human_world.hpp).
#include "testbed/simulation/human_world.hpp"

#include <cmath>

#include "diver/frames.hpp"
#include "engine/core/files.hpp"
#include "testbed/simulation/diver_condition.hpp"

namespace neritic::testbed {
namespace {

// For contacts, of a body of 1.78 m: trunk with tank and arms, and legs with fins.
void set_shape(PhysicsHuman& human) {
  const double s = human.body.height_m / 1.78;
  const bool worn = human.body.tank_count > 0;
  const Quat level(1.0, 0.0, 0.0, 0.0);
  human.shape.add_box({s * Vec3(0.0, worn ? 0.09 : 0.0, -0.36), level},
                      s * Vec3(0.24, worn ? 0.23 : 0.13, 0.46));
  human.shape.add_box({s * Vec3(0.0, 0.0, 0.62), level}, s * Vec3(0.18, 0.12, 0.52));
}

int node_named(const scene::Model& model, std::string_view name) {
  for (std::size_t i = 0; i < model.nodes.size(); ++i)
    if (model.nodes[i].name == name) return static_cast<int>(i);
  return -1;
}

// How much larger than the model the diver is: trunk, thigh and shank, from joint to joint.
double drawn_scale(const scene::Model& model, const PhysicsHuman& human) {
  double drawn_m = 0.0, body_m = 0.0;
  for (const diver::Segment segment :
       {diver::kAbdomen, diver::kThorax, diver::kHead, diver::kRightLowerLeg, diver::kRightFoot}) {
    const auto node = static_cast<std::size_t>(human.nodes[segment]);
    drawn_m += glm::length(model.nodes[node].translation_m);
    body_m += glm::length(human.body.segments[segment].joint_m);
  }
  return drawn_m > 0.0 ? body_m / drawn_m : 1.0;
}

// Gear that the model has on nodes of its own (tools/assets/README.md), as this diver wears it: a
// blade as long and wide as his fins, of any size of body.
void find_gear(const scene::Model& model, PhysicsHuman& human) {
  const diver::Gear& gear = human.file.parameters.gear;
  const auto worn = [&](const char* name, const Vec3& scale, bool swells = false) {
    const int node = node_named(model, name);
    if (node < 0) return;
    human.nodes.push_back(node);
    human.gear.push_back({scale, swells});
  };
  const Vec3 tank(gear.tanks.empty() ? 0.0 : 1.0), jacket(gear.jacket ? 1.0 : 0.0);
  for (const char* name : {"tank", "regulator"}) worn(name, tank);
  // Belt and collar stay on the body.
  for (const char* name : {"jacket_pelvis", "jacket_head"}) worn(name, jacket);
  for (const char* name : {"jacket_abdomen", "jacket_thorax"}) worn(name, jacket, true);
  const diver::Fins usual, fins = gear.fins.value_or(usual);
  const Vec3 blade(fins.width_m / usual.width_m / human.scale, 1.0,
                   fins.length_m / usual.length_m / human.scale);
  for (const char* name : {"fin_l", "fin_r"}) worn(name, Vec3(gear.fins ? 1.0 : 0.0));
  for (const char* name : {"blade_l", "blade_r"}) worn(name, blade);
}

Status find_nodes(const scene::Scene& scene, const scene::Object& object, PhysicsHuman& human) {
  const scene::Model& model = *scene.models[static_cast<std::size_t>(object.model)];
  std::string_view missing;
  DrawnJoints joints = drawn_joints_of(model, missing);
  if (!missing.empty())
    return bad_input("{}: {}: human: a model without the node '{}' found; accepted: nodes of {}",
                     scene.path, object.name, missing, "the 16 segments' names");
  human.nodes = std::move(joints.nodes);
  human.arms_spread_rad = joints.arms_spread_rad;
  human.scale = drawn_scale(model, human);
  find_gear(model, human);
  return {};
}

}  // namespace

DrawnJoints drawn_joints_of(const scene::Model& model, std::string_view& missing) {
  DrawnJoints out;
  for (const std::string_view name : diver::kSegmentNames) {
    out.nodes.push_back(node_named(model, name));
    if (out.nodes.back() >= 0) continue;
    missing = name;
    return {};
  }
  // The way from shoulder to elbow.
  const auto elbow = static_cast<std::size_t>(out.nodes[diver::kRightForearm]);
  const Vec3& arm = model.nodes[elbow].translation_m;
  out.arms_spread_rad = std::atan2(arm.x, -arm.y);
  return out;
}

Result<PhysicsHuman> physics_human(const scene::Scene& scene, std::size_t index) {
  const scene::Object& object = scene.objects[index];
  PhysicsHuman human;
  human.name = object.name;
  human.object = index;
  NERITIC_TRY(human.file,
              diver::read_diver(object.human->file, scene.physics->water_kg_m3,
                                1e5 * diver::surface_bar_at(scene.physics->altitude_m)));
  const Pose at = scene.world_from(object.mount, 0.0);
  human.file.parameters.start_depth_m = std::clamp(ned_from_world(at.position_m).z, 0.0, 1e9);
  NERITIC_TRY(human.body, diver::make_body(human.file.parameters));
  if (scene.water && scene.water->column) human.body.layers.emplace(*scene.water->column);
  NERITIC_TRY(diver::DiveComputer computer, diver::DiveComputer::create(human.file.computer));
  human.computer = std::make_unique<const diver::DiveComputer>(std::move(computer));
  if (object.human->swim) {
    const scene::SwimPlan& plan = *object.human->swim;
    for (const Vec3& p : plan.waypoints_m) human.waypoints_ned_m.push_back(ned_from_world(p));
    human.speed_m_s = plan.speed_m_s;
    human.speed_over = plan.speed_over;
    human.acceptance_m = plan.acceptance_m;
    human.repeat = plan.repeat;
    if (!plan.motion.empty()) {
      NERITIC_TRY(const std::string text, read_text(plan.motion));
      NERITIC_TRY(human.recording, diver::read_limb_recording(text, plan.motion.string()));
    }
  }
  if (const auto& path = object.human->jacket_buttons; !path.empty()) {
    if (human.body.jacket.capacity_m3 == 0.0)
      return bad_input("{}: {}: jacket_buttons: no such key for a diver without a jacket ({})",
                       scene.path, object.name, object.human->file.string());
    NERITIC_TRY(const std::string text, read_text(path));
    NERITIC_TRY(human.buttons, diver::read_button_recording(text, path.string()));
  }
  if (object.human->condition)
    human.condition = physics_condition(*object.human->condition, human.file);
  if (object.human->regulator) {
    auto regulator = physics_regulator(*object.human->regulator, human.body);
    if (!regulator.ok())
      return bad_input("{}: {}: {}", scene.path, object.name, regulator.error().message);
    human.regulator = std::move(regulator).value();
  }
  set_shape(human);
  NERITIC_TRY_STATUS(find_nodes(scene, object, human));
  human.start.human = diver::start_at(
      human.body, ned_from_world(at.position_m), diver::ned_from_standing(at.rotation),
      human.recording ? human.recording->joints.front()
                      : diver::rotations_of(diver::streamlined(human.body)));
  if (human.file.gas_switching.by_plan) {
    const double depth_m = human.start.human.root.position_ned_m.z;
    human.start.tank =
        diver::tank_to_breathe(human.computer->settings().gases, human.body,
                               human.start.human.life.tanks, {0, depth_m, depth_m, depth_m, false});
  }
  human.start.human.held.tank = human.start.tank;
  // Put there from the surface this moment.
  human.start.human.life.computer = human.computer->step(
      human.computer->start(), {human.start.human.root.position_ned_m.z, human.start.tank}, 0.0);
  human.start.leg_from_ned_m = human.start.human.root.position_ned_m;
  return human;
}

}  // namespace neritic::testbed
