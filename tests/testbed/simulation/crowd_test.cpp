// Many participants in one scene: threads that share a step, and memory.
#include <atomic>
#include <cstdlib>
#include <new>

#include "tests/testbed/simulation/dives.hpp"
#include "tools/benchmark/fleet_scene.hpp"

// Counts what this program allocates. Sanitizers bring allocators of their own.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define NERITIC_COUNTS_ALLOCATIONS
static std::atomic<std::size_t> allocations{0};
void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size > 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
#endif

namespace neritic::testbed {
namespace {

scene::Scene crowd_of(std::size_t vehicles, std::size_t divers) {
  const test::ScratchFolder scratch;
  return bench::fleet_scene((test::source_dir() / "assets").string(), scratch.path(), vehicles,
                            divers)
      .value();
}

// So close that they push one another, on and beside a block of stone.
scene::Scene dense_crowd_of(std::size_t vehicles, std::size_t divers) {
  scene::Scene scene = crowd_of(vehicles, divers);
  for (scene::Object& object : scene.objects) {
    Vec3& at_m = object.mount.pose.position_m;
    at_m = Vec3(0.25 * at_m.x, -10.0 + 0.3 * (at_m.y + 10.0), 0.15 * at_m.z);
  }
  scene::Scene stone = load_text(std::string(kStillWater) +
                                 "[[objects]]\nname = \"stone\"\nclass = \"rock\"\n"
                                 "shape = \"box\"\nsize_m = [12, 2, 12]\n"
                                 "collision = true\nposition_m = [6, -11.4, 0]\n")
                           .value();
  scene::Object block = stone.objects.front();
  block.model = static_cast<int>(scene.models.size());
  block.instance = 60000;
  scene.models.push_back(stone.models[static_cast<std::size_t>(stone.objects.front().model)]);
  scene.objects.push_back(std::move(block));
  return scene;
}

std::size_t touched(const PhysicsState& state) {
  std::size_t count = 0;
  for (const VehicleState& vehicle : state.vehicles())
    count += vehicle.contact.touched_steps > 0 ? 1 : 0;
  return count;
}

TEST(Crowd, AThousandVehiclesAndSixtyFourDiversStepWithTheSameBitsOnAnyNumberOfThreads) {
  const TestDive dive = dive_of(crowd_of(1000, 64));
  ASSERT_EQ(dive.state().vehicles().size(), 1000u);
  ASSERT_EQ(dive.state().humans().size(), 64u);
  EXPECT_EQ(dive.state().bytes().size(), 1000 * sizeof(VehicleState) + 64 * sizeof(HumanPhysics));
  constexpr std::uint64_t kSteps = 12;
  const auto alone = dive.world->simulation({}, 1);
  alone->advance(kSteps);
  EXPECT_EQ(alone->refused_states(), 0u);
  for (const unsigned threads : {0u, 2u, 5u}) {
    const auto shared = dive.world->simulation({}, threads);
    shared->advance(kSteps);
    EXPECT_EQ(shared->log().hashes, alone->log().hashes) << threads;
  }
}

TEST(Crowd, ThatTouchesStepsWithTheSameBitsOnAnyNumberOfThreads) {
  const TestDive dive = dive_of(dense_crowd_of(60, 6));
  const auto alone = dive.world->simulation({}, 1), shared = dive.world->simulation({}, 3);
  alone->advance(120);
  shared->advance(120);
  EXPECT_EQ(shared->log().hashes, alone->log().hashes);
  EXPECT_GT(touched(alone->newest().state), 20u);
}

#ifdef NERITIC_COUNTS_ALLOCATIONS
// Steps of a simulation that has run for a while, its readers and its hash included.
std::size_t allocations_of(const PhysicsWorld& world, std::uint64_t before, std::uint64_t steps,
                           unsigned threads) {
  const auto simulation = world.simulation({.log = false}, threads);
  auto reader = simulation->reader();
  simulation->advance(before);
  const std::size_t begin = allocations;
  simulation->advance(steps);
  reader.update();
  return allocations - begin;
}

TEST(Crowd, AStepInOpenWaterAllocatesNothing) {
  const TestDive dive = dive_of(crowd_of(50, 3));
  EXPECT_EQ(allocations_of(*dive.world, 0, 60, 1), 0u);
  EXPECT_EQ(allocations_of(*dive.world, 0, 60, 3), 0u);
}

TEST(Crowd, AStepWithContactsAllocatesOnlyForMoreOfThemThanEver) {
  const TestDive dive = dive_of(dense_crowd_of(60, 6));
  EXPECT_EQ(allocations_of(*dive.world, 240, 120, 1), 0u);
  EXPECT_GT(touched(dive.world->step(dive.state(), dive.world->start_inputs(), {0, 1.0 / 240.0})),
            10u);
}
#endif

}  // namespace
}  // namespace neritic::testbed
