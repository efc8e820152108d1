#include "testbed/motion/motion_history.hpp"

#include <algorithm>

#include "engine/core/check.hpp"
#include "rov/frames.hpp"
#include "testbed/simulation/object_motion.hpp"

namespace neritic::testbed {
namespace {

int index_in(const std::vector<int>& table, std::size_t object) {
  return object < table.size() ? table[object] : -1;
}

}  // namespace

MotionHistory::MotionHistory(std::vector<Moved> moved, std::vector<FollowedPoint> followed)
    : moved_(std::move(moved)), ring_(kKept), trails_(std::move(followed)) {
  int joints = 0;
  for (std::size_t i = 0; i < moved_.size(); ++i) {
    const std::size_t object = moved_[i].object;
    if (object >= place_.size()) {
      place_.resize(object + 1, -1);
      joints_.resize(object + 1, -1);
    }
    place_[object] = static_cast<int>(i);
    if (!moved_[i].nodes.empty()) joints_[object] = joints++;
  }
}

void MotionHistory::add(MotionSnapshot snapshot) {
  NERITIC_CHECK(snapshot.motions.size() == moved_.size(), "{} motions of {} objects",
                snapshot.motions.size(), moved_.size());
  if (count_ > 0 && snapshot.time_s <= newest_s()) return;
  ring_[added_++ % ring_.size()] = std::move(snapshot);
  count_ = std::min(count_ + 1, ring_.size());
}

void MotionHistory::trace(MotionSnapshot snapshot, const Trails::Wash& wash) {
  const double time_s = snapshot.time_s;
  MotionHistory alone(moved_);
  alone.add(std::move(snapshot));
  trails_.add(alone, time_s, wash);
}

void MotionHistory::clear() {
  added_ = count_ = 0;
  trails_.clear();
}

// The age of the newest snapshot that is not later than time_s; the oldest where all are later.
std::size_t MotionHistory::age_before(double time_s) const {
  std::size_t newest = 0, oldest = count_ - 1;
  while (newest < oldest) {
    const std::size_t middle = (newest + oldest) / 2;
    if (at_age(middle).time_s > time_s)
      newest = middle + 1;
    else
      oldest = middle;
  }
  return newest;
}

std::optional<scene::MotionAt> MotionHistory::at(std::size_t object, double time_s) const {
  const int place = index_in(place_, object);
  if (place < 0 || count_ == 0) return std::nullopt;
  const auto index = static_cast<std::size_t>(place);
  const std::size_t age = age_before(time_s);
  const MotionSnapshot& before = at_age(age);
  if (!before.motions[index]) return std::nullopt;
  const Motion& from = *before.motions[index];
  const double since_s = time_s - before.time_s;
  if (since_s == 0.0) return scene::MotionAt{from};
  if (since_s < 0.0) return scene::MotionAt{{from.pose}, scene::Knowledge::kHeld};
  if (age > 0) {
    const MotionSnapshot& after = at_age(age - 1);
    const double share = since_s / (after.time_s - before.time_s);
    // It goes back to its own track or place after what was known here.
    const Motion& to = after.motions[index] ? *after.motions[index] : from;
    return scene::MotionAt{between(from, to, share), scene::Knowledge::kBetween};
  }
  if (since_s <= kMostPredicted_s)
    return scene::MotionAt{predicted(from, since_s), scene::Knowledge::kPredicted, since_s};
  return scene::MotionAt{
      {predicted(from, kMostPredicted_s).pose}, scene::Knowledge::kHeld, since_s};
}

std::optional<scene::NodeKeys> MotionHistory::keys_around(std::size_t object,
                                                          const scene::Model& model,
                                                          double time_s) const {
  const int place = index_in(joints_, object);
  // A scene that shows another's motion may have nobody there.
  if (place < 0 || count_ == 0 || model.nodes.empty()) return std::nullopt;
  const auto index = static_cast<std::size_t>(place);
  const std::size_t age = age_before(time_s);
  const scene::NodeKey& before = at_age(age).joints[index];
  if (before.rotations.empty()) return std::nullopt;
  scene::NodeKeys keys{moved_[static_cast<std::size_t>(place_[object])].nodes, &before};
  if (age > 0 && time_s >= before.time_s && !at_age(age - 1).joints[index].rotations.empty())
    keys.after = &at_age(age - 1).joints[index];
  keys.most_ahead_s = kMostPredicted_s;
  return keys;
}

std::optional<scene::ModelPose> MotionHistory::model_pose(std::size_t object,
                                                          const scene::Model& model,
                                                          double time_s) const {
  const auto keys = keys_around(object, model, time_s);
  if (!keys) return std::nullopt;
  return scene::evaluate_pose(model, *keys, time_s);
}

std::optional<Mat4> MotionHistory::model_from_node(std::size_t object, const scene::Model& model,
                                                   int node, double time_s) const {
  const auto keys = keys_around(object, model, time_s);
  if (!keys) return std::nullopt;
  return scene::evaluate_node(model, node, *keys, time_s);
}

std::vector<MotionHistory::Moved> moved_objects(const PhysicsWorld& world) {
  std::vector<MotionHistory::Moved> moved;
  for (const PhysicsVehicle& vehicle : world.vehicles()) {
    MotionHistory::Moved drawn{vehicle.object, {}};
    if (vehicle.turning)
      for (const DrawnPropeller& propeller : vehicle.kind.propellers)
        drawn.nodes.push_back(propeller.node);
    moved.push_back(std::move(drawn));
  }
  for (const PhysicsHuman& human : world.humans()) moved.push_back({human.object, human.nodes});
  for (const PhysicsObject& object : world.objects())
    moved.push_back({object.object, object.joints.nodes});
  for (const PhysicsTether& tether : world.tethers().all()) {
    MotionHistory::Moved drawn{tether.object, {}};
    for (std::uint32_t j = 0; j <= tether.cable.segments * scene::kTetherJoints; ++j)
      drawn.nodes.push_back(static_cast<int>(j) + 1);
    moved.push_back(std::move(drawn));
  }
  return moved;
}

MotionSnapshot motion_of(const PhysicsWorld& world, const sim::Snapshot<PhysicsState>& snapshot) {
  MotionSnapshot out;
  out.time_s = snapshot.time_s;
  for (std::size_t i = 0; i < world.vehicles().size(); ++i) {
    const PhysicsVehicle& vehicle = world.vehicles()[i];
    const VehicleState& state = snapshot.state.vehicles()[i];
    out.motions.push_back(motion_of(state));
    if (vehicle.turning)
      out.joints.push_back(drawn_turns(
          vehicle.kind.propellers, vehicle.vehicle, state.body, vehicle.water.water_kg_m3,
          snapshot.state.propellers()[*vehicle.turning], snapshot.time_s));
  }
  for (std::size_t i = 0; i < world.humans().size(); ++i) {
    const HumanPhysics& state = snapshot.state.humans()[i];
    out.motions.push_back(motion_of(state));
    out.joints.push_back(drawn_joints(world.humans()[i], state, snapshot.time_s));
  }
  for (const ObjectState& object : snapshot.state.objects())
    out.motions.push_back(motion_of(object));
  for (const PhysicsObject& object : world.objects())
    if (object.limbs)
      out.joints.push_back(
          drawn_joints(object.joints, snapshot.state.limbs()[*object.limbs], snapshot.time_s));
  for (std::size_t i = 0; i < world.tethers().all().size(); ++i) {
    const TetherState& tether = snapshot.state.tethers()[i];
    out.motions.push_back(
        Motion{Pose{rov::world_from_ned(tether.top_ned_m)}, Vec3(0.0), Vec3(0.0)});
    out.joints.push_back(
        drawn_tether(world.tethers().nodes(snapshot.state, i), tether, snapshot.time_s));
  }
  return out;
}

}  // namespace neritic::testbed
