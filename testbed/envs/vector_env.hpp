// Many small worlds of one vehicle each, stepped together for learning: Gymnasium's vector
// interface over arrays of the caller. Each environment depends on its seed and its own actions
// alone: the same bits in any place among any others, on any number of threads. One thread at a
// time calls it.
//
// Observations are over the vehicle's own axes, forward, left, up (metres, seconds, radians), with
// the noise that its randomisation says.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/sim/workers.hpp"
#include "testbed/envs/tasks.hpp"

namespace neritic::testbed {

struct VectorEnvOptions {
  Task task = Task::kHover;
  std::size_t count = 1;
  std::filesystem::path vehicle;
  double step_s = 0.04;
  std::uint32_t most_steps = 500;  // then an episode is truncated
  EnvMethod method;
  Randomisation random;
  // Forces and moments of the six axes, shares of the largest, instead of a share for each
  // thruster.
  bool wrench = false;
  // Reset in the step in which it ended, instead of the next one, which then takes no action.
  bool same_step_reset = false;
  unsigned threads = 0;  // 0: all cores
};

// Arrays of the caller, one row an environment.
struct EnvArrays {
  static constexpr std::size_t kGoal = 12, kMotion = 10;
  // To the goal: place (3), its velocity less the vehicle's (3), turn (3); to the task's point (3).
  float* goal = nullptr;
  // Velocity over ground (3), angular velocity (3), up (3), depth.
  float* motion = nullptr;
  float* action = nullptr;  // the newest
  float* reward = nullptr;
  std::uint8_t *terminated = nullptr, *truncated = nullptr;
  // With same_step_reset: the last observation of an episode that ended.
  float *last_goal = nullptr, *last_motion = nullptr, *last_action = nullptr;
};

class VectorEnv {
 public:
  static Result<std::unique_ptr<VectorEnv>> create(const VectorEnvOptions& options);

  std::size_t count() const { return envs_.size(); }
  std::size_t actions() const { return actions_; }  // of an environment
  const VectorEnvOptions& options() const { return options_; }
  const EnvModel& model() const { return *model_; }
  unsigned threads() const { return workers_.threads(); }

  // seeds: one each. Those with a seed begin its first episode, the others their next one.
  void reset(std::span<const std::optional<std::uint64_t>> seeds, const EnvArrays& out);
  // actions: actions() an environment, each from -1 to 1, cut to that; one that is not a number is
  // 0.
  void step(std::span<const float> actions, const EnvArrays& out);
  // True motion: place and rotation (x y z w) in the world, velocities over ground in the body; ROS
  // conventions (east, north, up; forward, left, up). 13 an environment.
  void truth(std::span<double> out) const;
  // Other values for what is random, from the next episode of each on.
  void set_random(const Randomisation& random) { options_.random = random; }

 private:
  struct Env {
    EnvVehicle vehicle;
    TaskState task;
    std::uint64_t seed = 0, episode = 0;
    std::uint32_t step = 0;
    bool over = false;  // the next step begins another episode
  };
  VectorEnv(const VectorEnvOptions& options, std::unique_ptr<const EnvModel> model);
  void begin(std::size_t i);
  void observe(std::size_t i, float* goal, float* motion) const;
  void step_one(std::size_t i, const float* actions, const EnvArrays& out);
  template <class One>
  void for_each(const One& one);

  VectorEnvOptions options_;
  std::unique_ptr<const EnvModel> model_;
  std::size_t actions_ = 0;
  std::vector<Env> envs_;
  sim::Workers workers_;
};

}  // namespace neritic::testbed
