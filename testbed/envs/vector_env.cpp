#include "testbed/envs/vector_env.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <thread>

#include "engine/core/refusal.hpp"
#include "engine/core/ros_frames.hpp"
#include "rov/controller.hpp"

namespace neritic::testbed {
namespace {

constexpr std::size_t kMostEnvs = 1 << 20;
constexpr std::size_t kTogether = 32;  // environments of a thread's task

// Places of an environment's dice: start_of() and begin() have those below.
constexpr std::uint64_t kNoise = 100;

void put(const Vec3& marine, float* out) {
  const Vec3 flu = ros::flu_from_marine(marine);
  for (int i = 0; i < 3; ++i) out[i] = static_cast<float>(flu[i]);
}

// Each array may be absent.
void put_row(const float* from, std::size_t count, std::size_t row, float* array) {
  if (array) std::memcpy(array + row * count, from, count * sizeof(float));
}

Status check(const char* name, double value, double most) {
  if (value >= 0.0 && value <= most) return {};
  return refusal(name, fmt::format("{}", value), fmt::format("0 to {}", most));
}

Status check(const Randomisation& r) {
  for (const auto& [name, value, most] : {std::tuple("mass", r.mass, 0.5),
                                          {"net_buoyancy_n", r.net_buoyancy_n, 50.0},
                                          {"drag", r.drag, 0.9},
                                          {"thrust", r.thrust, 0.9},
                                          {"current_m_s", r.current_m_s, 5.0},
                                          {"position_noise_m", r.position_noise_m, 10.0},
                                          {"velocity_noise_m_s", r.velocity_noise_m_s, 10.0},
                                          {"angle_noise_rad", r.angle_noise_rad, 3.0},
                                          {"rate_noise_rad_s", r.rate_noise_rad_s, 10.0}})
    NERITIC_TRY_STATUS(check(name, value, most));
  return {};
}

}  // namespace

Result<std::unique_ptr<VectorEnv>> VectorEnv::create(const VectorEnvOptions& options) {
  if (options.count < 1 || options.count > kMostEnvs)
    return refusal("num_envs", fmt::format("{}", options.count), fmt::format("1 to {}", kMostEnvs));
  if (options.most_steps < 1) return refusal("max_steps", "0", "1 or more");
  if (options.threads > sim::kMostThreads)
    return refusal("threads", fmt::format("{}", options.threads),
                   fmt::format("0 (all cores) to {}", sim::kMostThreads));
  NERITIC_TRY_STATUS(check(options.random));
  NERITIC_TRY(auto model, EnvModel::read(options.vehicle, options.step_s, options.method));
  return std::unique_ptr<VectorEnv>(new VectorEnv(options, std::move(model)));
}

VectorEnv::VectorEnv(const VectorEnvOptions& options, std::unique_ptr<const EnvModel> model)
    : options_(options),
      model_(std::move(model)),
      actions_(options.wrench ? 6 : model_->thrusters()),
      envs_(options.count),
      workers_(std::min<unsigned>(
          options.threads > 0 ? options.threads : std::max(1u, std::thread::hardware_concurrency()),
          static_cast<unsigned>((options.count + kTogether - 1) / kTogether))) {}

template <class One>
void VectorEnv::for_each(const One& one) {
  workers_.run((envs_.size() + kTogether - 1) / kTogether, [&](std::size_t task, unsigned) {
    const std::size_t end = std::min(envs_.size(), (task + 1) * kTogether);
    for (std::size_t i = task * kTogether; i < end; ++i) one(i);
  });
}

void VectorEnv::begin(std::size_t i) {
  Env& env = envs_[i];
  const Dice dice(env.seed, env.episode, 0);
  const Start start = start_of(options_.task, dice);
  env.task = start.state;
  env.vehicle.begin(*model_, options_.random, dice, start.position_ned_m,
                    rov::heading_attitude(start.heading_rad));
  env.step = 0;
  env.over = false;
}

void VectorEnv::reset(std::span<const std::optional<std::uint64_t>> seeds, const EnvArrays& out) {
  NERITIC_CHECK(seeds.size() == envs_.size(), "{} seeds", seeds.size());
  for_each([&](std::size_t i) {
    if (seeds[i]) {
      envs_[i].seed = *seeds[i];
      envs_[i].episode = 0;
    } else {
      ++envs_[i].episode;
    }
    begin(i);
    observe(i, out.goal + i * EnvArrays::kGoal, out.motion + i * EnvArrays::kMotion);
    std::fill_n(out.action + i * actions_, actions_, 0.0f);
  });
}

// With noise that follows from the step alone.
void VectorEnv::observe(std::size_t i, float* goal, float* motion) const {
  const Env& env = envs_[i];
  const rov::WaterMotion& m = env.vehicle.motion;
  const Goal& g = env.task.goal;
  const Randomisation& r = options_.random;
  const Dice dice(env.seed, env.episode, env.step);
  const auto noise = [&](std::uint64_t place, double by) {
    if (by == 0.0) return Vec3(0.0);
    return by * Vec3(dice.normal(kNoise + place), dice.normal(kNoise + place + 1),
                     dice.normal(kNoise + place + 2));
  };
  const Quat to_body = glm::conjugate(m.attitude);
  const rov::Vec6 velocity = env.vehicle.velocity();
  const Vec3 place_noise = noise(0, r.position_noise_m),
             speed = velocity.linear() + noise(3, r.velocity_noise_m_s);
  put(to_body * (g.position_ned_m - m.position_ned_m) + place_noise, goal);
  put(to_body * g.velocity_ned_m_s - speed, goal + 3);
  const Quat wanted = rov::heading_attitude(g.heading_rad);
  Quat turn = to_body * wanted;
  if (turn.w < 0.0) turn = -turn;
  const Vec3 axis(turn.x, turn.y, turn.z);
  const double sine = glm::length(axis);
  const double factor = sine < 1e-9 ? 2.0 : 2.0 * std::atan2(sine, turn.w) / sine;
  put(factor * axis + noise(6, r.angle_noise_rad), goal + 6);
  put(to_body * (g.point_ned_m - m.position_ned_m) + place_noise, goal + 9);
  put(speed, motion);
  put(velocity.angular() + noise(9, r.rate_noise_rad_s), motion + 3);
  put(to_body * Vec3(0.0, 0.0, -1.0) + noise(12, r.angle_noise_rad), motion + 6);
  motion[9] = static_cast<float>(m.position_ned_m.z + place_noise.z);
}

void VectorEnv::step_one(std::size_t i, const float* actions, const EnvArrays& out) {
  Env& env = envs_[i];
  float* const goal = out.goal + i * EnvArrays::kGoal;
  float* const motion = out.motion + i * EnvArrays::kMotion;
  float* const newest = out.action + i * actions_;
  if (env.over) {
    ++env.episode;
    begin(i);
    observe(i, goal, motion);
    std::fill_n(newest, actions_, 0.0f);
    out.reward[i] = 0.0f;
    out.terminated[i] = out.truncated[i] = 0;
    return;
  }
  std::array<double, rov::kMaxThrusters> command_n{};
  double effort = 0.0;
  rov::Vec6 wrench;
  for (std::size_t k = 0; k < actions_; ++k) {
    const float given = actions[k];
    const double share = std::isnan(given) ? 0.0 : std::clamp<double>(given, -1.0, 1.0);
    newest[k] = static_cast<float>(share);
    effort += share * share / static_cast<double>(actions_);
    if (options_.wrench) {
      wrench[k] = share * model_->most_wrench()[k];
    } else {
      const auto [least_n, most_n] = model_->limits_n()[k];
      command_n[k] = share * (share < 0.0 ? -least_n : most_n);
    }
  }
  if (options_.wrench) {
    wrench =
        rov::vec6(ros::flu_from_marine(wrench.linear()), ros::flu_from_marine(wrench.angular()));
    command_n = model_->allocator().allocate(wrench).force_n;
  }
  const double before = potential_of(options_.task, env.task, env.vehicle.motion);
  env.vehicle.step(*model_, std::span(command_n).first(model_->thrusters()));
  ++env.step;
  const Dice dice(env.seed, env.episode, env.step);
  advance(options_.task, dice, env.step * options_.step_s, options_.step_s,
          env.vehicle.motion.position_ned_m, env.task);
  const Worth worth =
      worth_of(options_.task, env.task, env.vehicle.motion, env.vehicle.velocity(), effort, before);
  out.reward[i] = static_cast<float>(worth.reward);
  out.terminated[i] = worth.ends ? 1 : 0;
  out.truncated[i] = !worth.ends && env.step >= options_.most_steps ? 1 : 0;
  observe(i, goal, motion);
  if (out.terminated[i] == 0 && out.truncated[i] == 0) return;
  if (!options_.same_step_reset) {
    env.over = true;
    return;
  }
  put_row(goal, EnvArrays::kGoal, i, out.last_goal);
  put_row(motion, EnvArrays::kMotion, i, out.last_motion);
  put_row(newest, actions_, i, out.last_action);
  ++env.episode;
  begin(i);
  observe(i, goal, motion);
  std::fill_n(newest, actions_, 0.0f);
}

void VectorEnv::step(std::span<const float> actions, const EnvArrays& out) {
  NERITIC_CHECK(actions.size() == actions_ * envs_.size(), "{} actions", actions.size());
  for_each([&](std::size_t i) { step_one(i, actions.data() + i * actions_, out); });
}

void VectorEnv::truth(std::span<double> out) const {
  NERITIC_CHECK(out.size() == 13 * envs_.size(), "{} numbers", out.size());
  for (std::size_t i = 0; i < envs_.size(); ++i) {
    const rov::WaterMotion& m = envs_[i].vehicle.motion;
    const rov::Vec6 v = envs_[i].vehicle.velocity();
    const Vec3 p = ros::enu_from_ned(m.position_ned_m), linear = ros::flu_from_marine(v.linear()),
               angular = ros::flu_from_marine(v.angular());
    const Quat q = ros::enu_from_ned(m.attitude);
    const double row[13] = {p.x,      p.y,      p.z,      q.x,       q.y,       q.z,      q.w,
                            linear.x, linear.y, linear.z, angular.x, angular.y, angular.z};
    std::copy(std::begin(row), std::end(row), out.begin() + static_cast<std::ptrdiff_t>(13 * i));
  }
}

}  // namespace neritic::testbed
