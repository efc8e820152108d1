// Scenes with physics written in tests, and their dives stepped in lock-step.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>

#include "engine/core/files.hpp"
#include "rov/frames.hpp"
#include "testbed/simulation/physics_world.hpp"
#include "tests/support/support.hpp"

namespace neritic::testbed {

struct TestDive {
  scene::Scene scene;
  std::unique_ptr<const PhysicsWorld> world;
  std::unique_ptr<PhysicsSimulation> simulation;

  const PhysicsState& state() const { return simulation->newest().state; }
  const VehicleState& vehicle(std::size_t i = 0) const { return state().vehicles()[i]; }
  Pose pose(std::size_t i = 0) const {
    return rov::world_pose(vehicle(i).body.position_ned_m, vehicle(i).body.attitude);
  }
  double speed_m_s(std::size_t i = 0) const {
    return glm::length(vehicle(i).body.velocity.linear());
  }
  double time_s() const { return simulation->newest().time_s; }
  // each: called after each step.
  void run(double seconds, const std::function<void()>& each = {}) {
    for (const double end = time_s() + seconds - 1e-9; time_s() < end;) {
      simulation->advance(1);
      if (each) each();
    }
  }
};

inline TestDive dive_of(scene::Scene scene) {
  TestDive dive{std::move(scene), nullptr, nullptr};
  auto world = PhysicsWorld::create(dive.scene);
  if (!world.ok()) {
    ADD_FAILURE() << world.error().message;
    std::abort();
  }
  dive.world = std::move(world).value();
  dive.simulation = dive.world->simulation({});
  return dive;
}

inline std::string vehicles_folder() {
  return (test::source_dir() / "assets/vehicles").string();
}

// A box of a BlueROV2 Heavy's size, with its dynamics; keys follow.
inline std::string rov_text(const std::string& keys, const std::string& name = "rov",
                            const std::string& dynamics = "bluerov2_heavy_dynamics.toml") {
  return "[[vehicles]]\nname = \"" + name + "\"\nshape = \"box\"\nsize_m = [0.57, 0.26, 0.46]\n" +
         "dynamics = \"" + vehicles_folder() + "/" + dynamics + "\"\n" + keys;
}

// An object that is a diver, of a diver's file or the shipped one; keys follow.
inline std::string diver_text(const std::string& keys, std::string human = {}) {
  const std::string assets = (test::source_dir() / "assets").string();
  if (human.empty()) human = assets + "/divers/recreational.toml";
  return "[[objects]]\nname = \"diver\"\nclass = \"diver\"\nmodel = \"" + assets +
         "/models/diver.glb\"\nhuman = \"" + human + "\"\n" + keys;
}

// Prone, facing north.
inline constexpr const char* kProne = "pitch_deg = -90\n";
inline constexpr const char* kStillWater = "title = \"still water\"\n[physics]\n";

inline Result<scene::Scene> load_text(const std::string& text) {
  const test::ScratchFolder scratch;
  EXPECT_TRUE(write_text(scratch / "dive.toml", text).ok());
  return scene::load_scene(scratch / "dive.toml");
}

// The dive of a scene's text; ends the program where it does not load.
inline TestDive dive_of(const std::string& text) {
  auto scene = load_text(text);
  if (!scene.ok()) {
    ADD_FAILURE() << scene.error().message;
    std::abort();
  }
  return dive_of(std::move(scene).value());
}

inline const scene::Scene& mission_scene() {
  static const scene::Scene scene =
      scene::load_scene(test::source_dir() / "assets/scenes/mission.toml").value();
  return scene;
}

// Heading in degrees from north towards east, 0 to 360.
inline double heading_deg(const Pose& pose) {
  const double deg = degrees(rov::heading_of(rov::ned_from_world(pose.rotation)));
  return deg < 0.0 ? deg + 360.0 : deg;
}

}  // namespace neritic::testbed
