// Speed of the vehicles' physics, without a device: one ROV with all its sensors, a thousand of
// them on one thread and on two, the hand-off of a state, and what the machine's arithmetic allows.
#include <algorithm>
#include <thread>

#include "engine/core/clock.hpp"
#include "engine/core/hash.hpp"
#include "rov/bluerov2.hpp"
#include "rov/closed_loop.hpp"
#include "testbed/simulation/physics_world.hpp"
#include "tools/benchmark/groups.hpp"

namespace neritic::bench {
namespace {

constexpr double kStep_s = 1.0 / 240.0;
constexpr int kStepsASecond = 240;
constexpr int kStepsAControl = 5;  // 48 Hz

// One ROV of the mission scene with every sensor that there is, each at every step.
struct Surveyor {
  scene::Scene scene;
  std::unique_ptr<const testbed::PhysicsWorld> world;
  rov::SensorSet sensors;
};

Result<Surveyor> make_surveyor(const Suite& suite) {
  Surveyor out;
  NERITIC_TRY(out.scene, scene::load_scene(suite.options().assets + "/scenes/mission.toml"));
  for (scene::Object& object : out.scene.objects)
    if (object.dynamics)
      object.dynamics->file = suite.options().assets + "/vehicles/bluerov2_heavy_dynamics.toml";
  NERITIC_TRY(out.world, testbed::PhysicsWorld::create(out.scene));
  NERITIC_TRY(
      const rov::VehicleFile survey,
      rov::read_vehicle(suite.options().assets + "/vehicles/bluerov2_heavy_survey_dynamics.toml",
                        out.scene.physics->water_kg_m3));
  out.sensors = survey.sensors;
  const double hz = 1.0 / out.world->step_s();
  out.sensors.imu->rate_hz = out.sensors.dvl->rate_hz = out.sensors.pressure->rate_hz = hz;
  out.sensors.compass->rate_hz = out.sensors.altimeter->rate_hz = out.sensors.usbl->rate_hz = hz;
  return out;
}

// Seconds of its mission round the wreck: control, thrusters, current, contacts, snapshots, hashes,
// and what its sensors say. parts: what a second took of it.
Sample survey(const Surveyor& surveyor, int seconds) {
  const testbed::PhysicsWorld& world = *surveyor.world;
  const auto simulation = world.simulation({});
  rov::SensorReadings readings;
  TimeNs of_steps = 0, of_sensors = 0;
  for (int i = 0; i < seconds * kStepsASecond; ++i) {
    const TimeNs begin = now_ns();
    simulation->advance(1);
    const TimeNs stepped = now_ns();
    const auto& newest = simulation->newest();
    rov::update_readings(surveyor.sensors, world.sensor_world(0), world.vehicles()[0].vehicle,
                         newest.state.vehicles()[0].body,
                         newest.state.vehicles()[0].contact.acceleration,
                         newest.time_s - world.step_s(), newest.time_s, readings);
    of_sensors += now_ns() - stepped;
    of_steps += stepped - begin;
  }
  Hash64 hash;
  hash.add(simulation->newest().hash);
  hash.add(sim::state_hash(readings));
  const double steps_ms = to_ms(of_steps) / seconds, sensors_ms = to_ms(of_sensors) / seconds;
  return {steps_ms + sensors_ms, {{"steps", steps_ms}, {"sensors", sensors_ms}}, hash.hex()};
}

// ROVs that fly to setpoints of their own in a current, each step all of them in turn.
class Fleet {
 public:
  explicit Fleet(std::size_t count)
      : vehicle_(rov::make_vehicle(rov::bluerov2_heavy()).value()),
        allocator_(vehicle_),
        gains_(rov::default_gains()),
        members_(count) {
    rov::prepare_steps(vehicle_, std::array{kStep_s});
  }

  void start() {
    for (std::size_t i = 0; i < members_.size(); ++i) {
      Member& m = members_[i] = {};
      const double number = static_cast<double>(i);
      m.state.position_ned_m = {3.0 * number, 0.0, 10.0};
      m.wanted.position_ned_m = m.state.position_ned_m + Vec3(2.0, std::sin(number), 0.5);
      m.wanted.attitude = rov::heading_attitude(0.01 * number);
    }
  }
  // A second of the members from first to end.
  void fly(std::size_t first, std::size_t end, bool controlled) {
    for (int step = 0; step < kStepsASecond; ++step)
      for (std::size_t i = first; i < end; ++i) {
        Member& m = members_[i];
        if (controlled ? step % kStepsAControl == 0 : step == 0) {
          m.inputs =
              rov::control_inputs(vehicle_, allocator_, gains_, m.wanted, m.state, m.control);
          m.inputs.current_ned_m_s = {0.2, 0.1, 0.0};
        }
        m.state = rov::step(vehicle_, m.state, m.inputs, kStep_s);
      }
  }
  std::string hash() const {
    Hash64 hash;
    for (const Member& m : members_) hash.add(sim::state_hash(m.state));
    return hash.hex();
  }
  std::size_t size() const { return members_.size(); }

 private:
  struct Member {
    rov::State state;
    rov::Setpoint wanted;
    rov::ControlState control;
    rov::Inputs inputs;
  };
  rov::Vehicle vehicle_;
  rov::Allocator allocator_;
  rov::ControlGains gains_;
  std::vector<Member> members_;
};

Contender fleet_second(const std::string& name, Fleet& fleet, bool controlled, unsigned threads) {
  return {
      name,
      [&fleet, controlled, threads]() -> Result<Sample> {
        fleet.start();
        const TimeNs begin = now_ns();
        std::vector<std::thread> workers;
        const auto share = [&](unsigned i) { return fleet.size() * i / threads; };
        for (unsigned i = 1; i < threads; ++i)
          workers.emplace_back([&, i] { fleet.fly(share(i), share(i + 1), controlled); });
        fleet.fly(0, share(1), controlled);
        for (std::thread& worker : workers) worker.join();
        return Sample{to_ms(now_ns() - begin), {}, fleet.hash()};
      },
      {{"vehicles", static_cast<double>(fleet.size())}, {"threads", static_cast<double>(threads)}}};
}

// A thousand hand-offs of the dive's state, so that milliseconds are microseconds each.
Sample hand_over(const testbed::PhysicsState& state) {
  sim::SnapshotSource<testbed::PhysicsState> source({state});
  auto reader = source.reader();
  std::uint64_t seen = 0;
  const TimeNs begin = now_ns();
  for (int i = 0; i < 1000; ++i) {
    source.next().state = state;
    source.next().step = static_cast<std::uint64_t>(i);
    source.put();
    reader.update();
    seen += reader.newest().step;
  }
  const double ms = to_ms(now_ns() - begin);
  return {ms, {}, fmt::format("{:016x}", seen)};
}

// Products and sums that wait for nothing, in registers: more a second than this, one core does not
// do with the instructions that all of this is compiled to (pairs; one number at a time: half).
using Doubles = double __attribute__((vector_size(16)));
constexpr int kChains = 12, kProducts = 1'000'000;
Sample multiply_and_add() {
  const Doubles by{0.999, 0.998}, on{0.5, 0.25};
  Doubles a = on, b = a + on, c = b + on, d = c + on, e = d + on, f = e + on, g = f + on,
          h = g + on, i = h + on, j = i + on, k = j + on, l = k + on;
  const TimeNs begin = now_ns();
  for (int n = 0; n < kProducts; ++n) {
    a = a * by + on, b = b * by + on, c = c * by + on, d = d * by + on, e = e * by + on;
    f = f * by + on, g = g * by + on, h = h * by + on, i = i * by + on, j = j * by + on;
    k = k * by + on, l = l * by + on;
  }
  const double ms = to_ms(now_ns() - begin);
  Hash64 hash;
  for (const Doubles& sum : {a, b, c, d, e, f, g, h, i, j, k, l}) {
    hash.add(sum[0]);
    hash.add(sum[1]);
  }
  return {ms, {}, hash.hex()};
}

}  // namespace

Status bench_physics(Suite& suite) {
  if (!suite.wants("physics")) return {};
  constexpr int kSeconds = 10;
  NERITIC_TRY(const Surveyor surveyor, make_surveyor(suite));
  Fleet fleet(1000);
  const testbed::PhysicsState state = surveyor.world->start();
  NERITIC_TRY_STATUS(
      suite.measure({{"physics/rov_all_sensors_240_hz",
                      [&]() -> Result<Sample> { return survey(surveyor, kSeconds); },
                      {{"seconds", double{kSeconds}}}},
                     fleet_second("physics/1000_rovs_steps", fleet, false, 1),
                     fleet_second("physics/1000_rovs_and_control", fleet, true, 1),
                     fleet_second("physics/1000_rovs_and_control_2_threads", fleet, true, 2),
                     {"physics/1000_hand_offs",
                      [&]() -> Result<Sample> { return hand_over(state); },
                      {{"bytes", 2.0 * static_cast<double>(state.bytes().size())}}},
                     {"physics/arithmetic",
                      []() -> Result<Sample> { return multiply_and_add(); },
                      {{"operations", 4.0 * kChains * kProducts}}}},
                    15));
  suite.must_agree("physics/1000_rovs_and_control", "physics/1000_rovs_and_control_2_threads");
  // Measured in processor time, so that other programs on the core do not count.
  if (const Measured* m = suite.find("physics/rov_all_sensors_240_hz"))
    suite.aim_most("one ROV with all sensors, share of a core", "%",
                   0.1 * median(m->cpu_ms) / kSeconds, 1.0);
  suite.aim_ms("a second of 1000 ROVs, two threads", "physics/1000_rovs_and_control_2_threads",
               1000.0);
  suite.aim_ms("1000 hand-offs of a dive's state", "physics/1000_hand_offs", 1.0);
  if (const Measured* m = suite.find("physics/arithmetic"))
    suite.note("gflop_a_second_of_a_core",
               4e-6 * kChains * kProducts / *std::ranges::min_element(m->cpu_ms));
  return {};
}

}  // namespace neritic::bench
