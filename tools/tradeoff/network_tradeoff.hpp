// `neritic tradeoff network`: what delay, jitter and loss between a person's devices and the scene
// do to the dive: how far the diver's limbs are from the person's, how far the diver strays from
// the same dive without a network, and how well a robot that follows keeps its distance. Simulated
// devices over real sockets of this machine, in simulated time. One thread.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "engine/scene/scene.hpp"

namespace neritic::tools {

struct NetworkTradeoffOptions {
  scene::Scene scene;    // with [sources] that a diver wears
  bool quick = false;    // three settings each, 10 s
  double dive_s = 60.0;  // of each run; quick: 10
  std::vector<double> delays_ms = {0, 20, 50, 100, 200, 400, 800};
  std::vector<double> jitters_ms = {0, 5, 10, 20, 50, 100, 200};
  std::vector<double> losses_percent = {0, 1, 2, 5, 10, 20, 50, 80};
  std::function<void()> step = [] {};  // after each of steps(options)
};
std::uint64_t steps(const NetworkTradeoffOptions& options);

struct NetworkPoint {
  std::string varied;  // "delay", "jitter", "loss"
  double delay_ms = 0.0, jitter_ms = 0.0, loss_percent = 0.0;
  // Over the dive after its first five seconds.
  double joints_deg = 0.0;      // rms over all joints: the diver's wanted less the person's now
  double leg_deg = 0.0;         // the largest of hip, knee and ankle, rms over time
  double astray_m = 0.0;        // rms distance from the dive without delay, jitter, loss
  double way_m = 0.0;           // swum
  double follow_m = 0.0;        // mean distance of the robot; 0: the scene has none
  double follow_rms_m = 0.0;    // of that distance from the one in the dive without a network
  double silent_percent = 0.0;  // of steps in which the autopilot swam
};

struct NetworkTradeoff {
  double dive_s = 0.0;
  std::vector<NetworkPoint> points;
};
// An Error where the scene has no diver with devices, or a port is taken.
Result<NetworkTradeoff> run_network_tradeoff(const NetworkTradeoffOptions& options);

// Writes network.csv, .md, .json and .plot.json into the folder. True: network.png was drawn too.
Result<bool> write_network_tradeoff(const std::filesystem::path& folder,
                                    const NetworkTradeoff& tradeoff);

}  // namespace neritic::tools
