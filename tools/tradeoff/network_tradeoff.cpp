#include "tools/tradeoff/network_tradeoff.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/refusal.hpp"
#include "testbed/simulators/lab.hpp"

namespace neritic::tools {
namespace {

using namespace testbed;

constexpr double kSettled_s = 5.0;

// The record of a dive, step by step.
struct Trace {
  std::vector<Vec3> diver_m;
  std::vector<double> robot_m;  // away from the diver
  NetworkPoint point;
};

double turn_rad(const Quat& a, const Quat& b) {
  const Quat d = glm::conjugate(a) * b;
  return 2.0 * std::atan2(glm::length(Vec3(d.x, d.y, d.z)), std::abs(d.w));
}

bool is_leg(std::size_t joint) {
  return diver::child_of(joint) >= diver::kLeftUpperLeg;
}

Result<Trace> dive_over(const scene::Scene& scene, const PhysicsWorld& world, double dive_s,
                        const NetworkPoint& setting) {
  const auto simulation = world.simulation({.log = false}, 1);
  NERITIC_TRY(const auto devices,
              Devices::open(scene, world, simulation->inbox(), DeviceSource::Pace::kPolled));
  LabOptions options;
  options.faults = {.delay_s = 1e-3 * setting.delay_ms,
                    .jitter_s = 1e-3 * setting.jitter_ms,
                    .loss = 1e-2 * setting.loss_percent};
  const auto seen = [&](std::size_t diver) -> const HumanPhysics& {
    return simulation->newest().state.humans()[diver];
  };
  NERITIC_TRY(const auto lab, SimulatedLab::create(scene, world, devices.get(), seen, options));
  Trace trace{.point = setting};
  double joints2 = 0.0, legs2 = 0.0;
  std::uint64_t counted = 0, silent = 0;
  while (simulation->newest().time_s < dive_s - 1e-9) {
    NERITIC_TRY_STATUS(lab->poll(simulation->inbox(), simulation->newest().time_s));
    simulation->advance(1);
    const auto& newest = simulation->newest();
    if (newest.time_s < kSettled_s && dive_s > 2.0 * kSettled_s) continue;
    const HumanPhysics& human = newest.state.humans()[0];
    const diver::JointRotations &wanted = lab->acts(0).joints, &given = human.human.held.joints;
    double sum2 = 0.0, leg = 0.0;
    for (std::size_t i = 0; i < diver::kJoints; ++i) {
      const double turn = turn_rad(wanted[i], given[i]);
      sum2 += turn * turn / diver::kJoints;
      if (is_leg(i)) leg = std::max(leg, turn);
    }
    joints2 += sum2;
    legs2 += leg * leg;
    ++counted;
    const GroupState& body = human.groups[static_cast<std::size_t>(DiverGroup::kBody)];
    silent += body.phase == GroupPhase::kLive ? 0 : 1;
    trace.diver_m.push_back(human.human.root.position_ned_m);
    if (newest.state.vehicles().size() > 0)
      trace.robot_m.push_back(glm::distance(newest.state.vehicles()[0].body.position_ned_m,
                                            human.human.root.position_ned_m));
  }
  const double n = std::max<double>(1.0, static_cast<double>(counted));
  trace.point.joints_deg = degrees(std::sqrt(joints2 / n));
  trace.point.leg_deg = degrees(std::sqrt(legs2 / n));
  trace.point.silent_percent = 100.0 * static_cast<double>(silent) / n;
  for (std::size_t i = 1; i < trace.diver_m.size(); ++i)
    trace.point.way_m += glm::distance(trace.diver_m[i], trace.diver_m[i - 1]);
  for (const double distance : trace.robot_m)
    trace.point.follow_m += distance / static_cast<double>(trace.robot_m.size());
  return trace;
}

void compare(const Trace& truth, Trace& trace) {
  const auto rms = [](const auto& a, const auto& b, auto apart) {
    double sum2 = 0.0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
      sum2 += std::pow(apart(a[i], b[i]), 2);
    return a.empty() ? 0.0 : std::sqrt(sum2 / static_cast<double>(a.size()));
  };
  trace.point.astray_m = rms(trace.diver_m, truth.diver_m,
                             [](const Vec3& a, const Vec3& b) { return glm::distance(a, b); });
  trace.point.follow_rms_m =
      rms(trace.robot_m, truth.robot_m, [](double a, double b) { return a - b; });
}

std::vector<double> some(const std::vector<double>& all, bool quick) {
  if (!quick || all.size() <= 3) return all;
  return {all.front(), all[all.size() / 2], all.back()};
}

std::vector<NetworkPoint> settings_of(const NetworkTradeoffOptions& options) {
  std::vector<NetworkPoint> out;
  for (const double ms : some(options.delays_ms, options.quick))
    out.push_back({.varied = "delay", .delay_ms = ms});
  for (const double ms : some(options.jitters_ms, options.quick))
    out.push_back({.varied = "jitter", .jitter_ms = ms});
  for (const double percent : some(options.losses_percent, options.quick))
    out.push_back({.varied = "loss", .loss_percent = percent});
  return out;
}

}  // namespace

std::uint64_t steps(const NetworkTradeoffOptions& options) {
  return settings_of(options).size() + 1;
}

Result<NetworkTradeoff> run_network_tradeoff(const NetworkTradeoffOptions& options) {
  if (options.scene.sources.empty())
    return refusal(options.scene.path, "a scene without [sources]",
                   "one whose diver wears devices, as assets/scenes/lab.toml");
  NERITIC_TRY(const auto world, PhysicsWorld::create(options.scene));
  NetworkTradeoff out{options.quick ? 10.0 : options.dive_s, {}};
  NERITIC_TRY(const Trace truth, dive_over(options.scene, *world, out.dive_s, {}));
  options.step();
  for (const NetworkPoint& setting : settings_of(options)) {
    NERITIC_TRY(Trace trace, dive_over(options.scene, *world, out.dive_s, setting));
    compare(truth, trace);
    out.points.push_back(trace.point);
    options.step();
  }
  return out;
}

}  // namespace neritic::tools
