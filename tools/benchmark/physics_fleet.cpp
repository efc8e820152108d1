// A scene of a thousand vehicles, alone and with divers among them, as `neritic dive` steps it:
// missions, control, current, pairs that may touch, snapshots and hashes.
#include <malloc.h>

#include <filesystem>

#include "engine/core/clock.hpp"
#include "testbed/simulation/physics_world.hpp"
#include "tools/benchmark/fleet_scene.hpp"
#include "tools/benchmark/groups.hpp"

namespace neritic::bench {
namespace {

constexpr std::size_t kFleet = 1000, kTeam = 64;

double heap_bytes() {
  const struct mallinfo2 now = mallinfo2();
  return static_cast<double>(now.uordblks + now.hblkhd);
}

// Bytes of the heap, of all participants: the world that is read once; a state, of which a
// simulation keeps three and each reader six; what a step works in; and all of a simulation.
struct Memory {
  double world = 0.0, state = 0.0, scratch = 0.0, simulation = 0.0;
};
Result<Memory> memory_of(const scene::Scene& scene) {
  const double empty = heap_bytes();
  NERITIC_TRY(const auto world, testbed::PhysicsWorld::create(scene));
  const double read = heap_bytes();
  const testbed::StepScratch scratch = world->scratch(1);
  const double worked = heap_bytes();
  const auto simulation = world->simulation({.log = false}, 1);
  return Memory{read - empty, static_cast<double>(world->start().bytes().size()), worked - read,
                heap_bytes() - worked};
}

void note_memory(Suite& suite, const std::string& whose, const Memory& with, const Memory& without,
                 std::size_t count) {
  const auto note = [&](const char* what, double Memory::*part) {
    suite.note(fmt::format("bytes_a_{}_of_{}", whose, what),
               std::round((with.*part - without.*part) / static_cast<double>(count)));
  };
  note("world", &Memory::world);
  note("state", &Memory::state);
  note("scratch", &Memory::scratch);
  note("simulation", &Memory::simulation);
}

// A second of simulated time, from the start.
Contender second_of(const std::string& name, const testbed::PhysicsWorld& world, unsigned threads) {
  return {name,
          [&world, threads]() -> Result<Sample> {
            const auto simulation = world.simulation({.log = false}, threads);
            const auto reader = simulation->reader();
            const auto steps = static_cast<std::uint64_t>(std::llround(1.0 / world.step_s()));
            const TimeNs begin = now_ns();
            simulation->advance(steps);
            return Sample{
                to_ms(now_ns() - begin), {}, fmt::format("{:016x}", simulation->newest().hash)};
          },
          {{"vehicles", static_cast<double>(world.vehicles().size())},
           {"divers", static_cast<double>(world.humans().size())},
           {"threads", static_cast<double>(threads)},
           {"bytes", static_cast<double>(world.start().bytes().size())}}};
}

}  // namespace

Status bench_physics_fleet(Suite& suite) {
  if (!suite.wants("physics")) return {};
  const std::string assets = std::filesystem::absolute(suite.options().assets).string();
  const auto folder = std::filesystem::temp_directory_path();
  NERITIC_TRY(const scene::Scene alone, fleet_scene(assets, folder, kFleet, 0));
  NERITIC_TRY(const scene::Scene both, fleet_scene(assets, folder, kFleet, kTeam));
  NERITIC_TRY(const auto vehicles, testbed::PhysicsWorld::create(alone));
  NERITIC_TRY(const auto crowd, testbed::PhysicsWorld::create(both));
  const std::string fleet = "physics/scene_1000_vehicles", all = fleet + "_64_divers";
  NERITIC_TRY_STATUS(suite.measure({{"physics/load_1000_vehicles",
                                     [&]() -> Result<Sample> {
                                       const TimeNs begin = now_ns();
                                       NERITIC_TRY(const auto world,
                                                   testbed::PhysicsWorld::create(alone));
                                       return Sample{to_ms(now_ns() - begin), {}, {}};
                                     },
                                     {{"vehicles", double{kFleet}}}},
                                    second_of(fleet, *vehicles, 1),
                                    second_of(fleet + "_2_threads", *vehicles, 2),
                                    second_of(all, *crowd, 1),
                                    second_of(all + "_2_threads", *crowd, 2)},
                                   3));
  suite.must_agree(fleet, fleet + "_2_threads");
  suite.must_agree(all, all + "_2_threads");
  suite.aim_ms("a second of a scene of 1000 vehicles, two threads", fleet + "_2_threads", 1000.0);
  suite.aim_ms("reading the physics of 1000 vehicles", "physics/load_1000_vehicles", 250.0);
  NERITIC_TRY(const Memory of_vehicles, memory_of(alone));
  NERITIC_TRY(const Memory of_all, memory_of(both));
  note_memory(suite, "vehicle", of_vehicles, {}, kFleet);
  note_memory(suite, "diver", of_all, of_vehicles, kTeam);
  return {};
}

}  // namespace neritic::bench
