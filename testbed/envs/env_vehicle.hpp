// A vehicle of a vectorised environment: rov's model with its own mass, drag, thrust and current.
// North, east, down; body axes forward, starboard, down. Plain value; one thread at a time.
#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include "rov/allocation.hpp"
#include "rov/integrators.hpp"
#include "rov/vehicle_file.hpp"
#include "testbed/envs/dice.hpp"

namespace neritic::testbed {

// How much environments differ. Shares are of the file's values, each way.
struct Randomisation {
  double mass = 0.05;           // and of inertia, weight and buoyancy with it
  double net_buoyancy_n = 1.0;  // on top of the file's, each way
  double drag = 0.3;            // linear and quadratic, each by itself
  double thrust = 0.1;          // of each thruster by itself
  double current_m_s = 0.3;     // at most, level, in any direction, steady in an episode
  // Deviations of what is observed.
  double position_noise_m = 0.02, velocity_noise_m_s = 0.02, angle_noise_rad = 0.01,
         rate_noise_rad_s = 0.01;

  static Randomisation none() { return {0, 0, 0, 0, 0, 0, 0, 0, 0}; }
};

// How a step is computed.
struct EnvMethod {
  enum class Kind {
    kSplit,    // the thrusters' lag exactly, the rest by RK4, in substeps (rov/integrators)
    kGuarded,  // as the simulation: as many substeps as the vehicle's state asks for (rov/step)
  } kind = Kind::kSplit;
  int substeps = 0;          // 0: as many as the step's length asks for
  bool thrust_table = true;  // commands in whole microseconds of the vehicle's table, as in a scene
};
Result<EnvMethod::Kind> env_method_of(std::string_view name);  // "split", "guarded"

// Shared by all vehicles of a batch.
class EnvModel {
 public:
  static Result<std::unique_ptr<const EnvModel>> read(const std::filesystem::path& vehicle,
                                                      double step_s, EnvMethod method);
  const rov::VehicleFile& file() const { return file_; }
  const rov::Vehicle& vehicle() const { return vehicle_; }
  const rov::Allocator& allocator() const { return allocator_; }
  std::size_t thrusters() const { return vehicle_.thruster_count; }
  // Least and most force of each thruster.
  std::span<const std::pair<double, double>> limits_n() const { return limits_n_; }
  // The largest force or moment of each axis alone.
  const rov::Vec6& most_wrench() const { return most_wrench_; }
  double step_s() const { return step_s_; }
  const EnvMethod& method() const { return method_; }
  // The thrust that a command gives by the file's table.
  double realised_n(double command_n) const;

 private:
  EnvModel(rov::VehicleFile file, rov::Vehicle vehicle, double step_s, const EnvMethod& method);
  rov::VehicleFile file_;
  rov::Vehicle vehicle_;
  rov::Allocator allocator_;
  rov::Vec6 most_wrench_;
  std::vector<std::pair<double, double>> limits_n_;
  double step_s_;
  EnvMethod method_;
  std::vector<std::uint32_t> first_at_;  // by buckets of force: where to look from
  double bucket_n_ = 1.0;
  std::vector<double> thrust_by_us_;  // one a whole microsecond; empty: no table
};

struct EnvVehicle {
  rov::Vehicle vehicle;
  rov::Inputs inputs;
  rov::WaterMotion motion;
  rov::LagStates lag{};
  std::array<double, rov::kMaxThrusters> thrust_factor{};

  // Another one of the model, at rest over ground there.
  void begin(const EnvModel& model, const Randomisation& random, const Dice& dice,
             const Vec3& position_ned_m, const Quat& attitude);
  // Commands in newtons.
  void step(const EnvModel& model, std::span<const double> command_n);
  // Over ground.
  rov::Vec6 velocity() const {
    return rov::over_ground(motion.attitude, motion.velocity, motion.current_ned_m_s);
  }
};

}  // namespace neritic::testbed
