#include "testbed/loop/live_physics.hpp"

#include "rov/frames.hpp"

namespace neritic::testbed {
namespace {

// Poses between, all else of the newer state.
PhysicsState blend_states(const PhysicsState& older, const PhysicsState& newer, double share) {
  PhysicsState out = newer;
  for (std::size_t i = 0; i < out.vehicles().size(); ++i) {
    const rov::State &a = older.vehicles()[i].body, &b = newer.vehicles()[i].body;
    const Pose pose =
        sim::blend_pose({a.position_ned_m, a.attitude}, {b.position_ned_m, b.attitude}, share);
    out.vehicles()[i].body.position_ned_m = pose.position_m;
    out.vehicles()[i].body.attitude = pose.rotation;
  }
  for (std::size_t i = 0; i < out.humans().size(); ++i) {
    const diver::HumanState &a = older.humans()[i].human, &b = newer.humans()[i].human;
    const Pose pose = sim::blend_pose({a.root.position_ned_m, a.root.attitude},
                                      {b.root.position_ned_m, b.root.attitude}, share);
    out.humans()[i].human.root.position_ned_m = pose.position_m;
    out.humans()[i].human.root.attitude = pose.rotation;
    for (std::size_t k = 0; k < diver::kJoints; ++k) {
      const Quat& from = a.limbs.rotation[k];
      const Quat to =
          glm::dot(from, b.limbs.rotation[k]) < 0.0 ? -b.limbs.rotation[k] : b.limbs.rotation[k];
      out.humans()[i].human.limbs.rotation[k] = glm::normalize(from * (1.0 - share) + to * share);
    }
  }
  return out;
}

}  // namespace

LivePhysics::LivePhysics(std::unique_ptr<const PhysicsWorld> world, Pace pace)
    : world_(std::move(world)),
      pace_(pace),
      simulation_(world_->simulation({.log = false})),
      reader_(simulation_->reader()),
      shown_(world_->start()) {}

Result<std::unique_ptr<LivePhysics>> LivePhysics::create(const scene::Scene& scene, Pace pace) {
  NERITIC_TRY(auto world, PhysicsWorld::create(scene));
  return std::unique_ptr<LivePhysics>(new LivePhysics(std::move(world), pace));
}

LivePhysics::~LivePhysics() {
  simulation_->stop();
}

void LivePhysics::start() {
  if (pace_ == Pace::kClock) simulation_->start(clock_);
}

void LivePhysics::place(scene::Scene& scene, TimeNs display_ns, double time_s) {
  if (pace_ == Pace::kPicture) {
    while (simulation_->newest().time_s < time_s) simulation_->advance(1);
    display_ns = std::llround(time_s * 1e9);
  }
  reader_.update();
  shown_ = reader_.at(display_ns, blend_states).state;
  for (std::size_t i = 0; i < world_->vehicles().size(); ++i) {
    scene::Mount& mount = scene.objects[world_->vehicles()[i].object].mount;
    mount.track.reset();
    mount.pose = pose(i);
  }
  for (std::size_t i = 0; i < world_->humans().size(); ++i) {
    const PhysicsHuman& human = world_->humans()[i];
    scene::Object& object = scene.objects[human.object];
    object.mount.track.reset();
    object.mount.pose = drawn_pose(shown_.humans()[i]);
    object.node_motion = {human.nodes, {drawn_joints(human, shown_.humans()[i], 0.0)}};
  }
}

bool LivePhysics::steer(std::size_t vehicle, const VehicleInputs& inputs) {
  return simulation_->push({.vehicle = vehicle, .inputs = inputs});
}

Pose LivePhysics::pose(std::size_t vehicle) const {
  const rov::State& body = shown_.vehicles()[vehicle].body;
  return rov::world_pose(body.position_ned_m, body.attitude);
}

}  // namespace neritic::testbed
