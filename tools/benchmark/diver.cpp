// The cost of a diver: a second of swimming with everything on (limbs, water, jacket, breath, gas,
// the swimmer's own decisions, the dive computer), with the full model and with the planar one.
#include <cmath>

#include "diver/deco_live.hpp"
#include "diver/swimmer.hpp"
#include "engine/core/clock.hpp"
#include "engine/sim/state_hash.hpp"
#include "testbed/simulation/physics_world.hpp"
#include "tools/benchmark/groups.hpp"

namespace neritic::bench {
namespace {

constexpr int kDiverHz = 240;
constexpr int kSwimSeconds = 5;

// Five seconds of a steady swim; the sample is the time of one.
Contender swimming(const std::string& name, diver::Model model, int strips) {
  return {
      "diver/" + name, [model, strips]() -> Result<Sample> {
        diver::BodyParameters p;
        p.model = model;
        p.strips_a_segment = strips;
        NERITIC_TRY(const diver::Body body, diver::make_body(p));
        NERITIC_TRY(const diver::DiveComputer computer, diver::DiveComputer::create({}));
        diver::HumanState state = diver::start_at(body, {0.0, 0.0, 15.0}, {1.0, 0.0, 0.0, 0.0},
                                                  diver::rotations_of(diver::streamlined(body)));
        state.life.computer = computer.start();
        diver::SwimmerState swimmer;
        diver::HumanInputs inputs;
        const TimeNs start = now_ns();
        for (int i = 0; i < kSwimSeconds * kDiverHz; ++i) {
          diver::swim(body, {}, {{1000.0, 0.0, 15.0}, 0.5}, state, swimmer, 1.0 / kDiverHz, inputs);
          state = diver::step(body, state, inputs, 1.0 / kDiverHz);
          if (i % (kDiverHz / 10) == 0)
            state.life.computer =
                computer.step(state.life.computer, {state.root.position_ned_m.z, 0}, 0.1);
        }
        const double ms = to_ms(now_ns() - start) / kSwimSeconds;
        return Sample{ms, {}, fmt::format("{:016x}", sim::state_hash(state))};
      }};
}

// Five seconds of the dive along the wreck as `neritic dive` steps it: the diver and the vehicle
// beside, contacts, current, snapshots and hashes; the sample is the time of one.
Contender diving(const testbed::PhysicsWorld& world) {
  return {"diver/scene_second_with_a_vehicle", [&world]() -> Result<Sample> {
            const auto simulation = world.simulation({});
            const auto steps = static_cast<std::uint64_t>(std::llround(1.0 / world.step_s()));
            const TimeNs start = now_ns();
            simulation->advance(kSwimSeconds * steps);
            const double ms = to_ms(now_ns() - start) / kSwimSeconds;
            return Sample{ms, {}, fmt::format("{:016x}", simulation->newest().hash)};
          }};
}

}  // namespace

Status bench_diver(Suite& suite) {
  if (!suite.wants("diver")) return {};
  NERITIC_TRY(const scene::Scene scene,
              scene::load_scene(suite.options().assets + "/scenes/dive.toml"));
  NERITIC_TRY(const auto world, testbed::PhysicsWorld::create(scene));
  const int strips = diver::BodyParameters{}.strips_a_segment;
  NERITIC_TRY_STATUS(suite.measure(
      {swimming("second_at_240_hz", diver::Model::kFull, strips),
       swimming("second_at_240_hz_16_strips", diver::Model::kFull, 16),
       swimming("second_at_240_hz_planar", diver::Model::kPlanar, strips), diving(*world)}));
  suite.aim_ms("a second of a diver at 240 Hz, 1 % of a core", "diver/second_at_240_hz", 10.0);
  return {};
}

}  // namespace neritic::bench
