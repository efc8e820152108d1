#include "tools/tradeoff/mission_flights.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "engine/core/files.hpp"
#include "engine/core/random.hpp"
#include "rov/step_choice.hpp"
#include "testbed/simulation/physics_world.hpp"

namespace neritic::tools {
using namespace testbed;
namespace {

constexpr double kSample_s = 0.1;
constexpr double kTruth_hz = 8000.0, kTruthInContact_hz = 32000.0;

constexpr const char* kVehicles[] = {"bluerov2_heavy_dynamics.toml",
                                     "bluerov2_heavy_manual_dynamics.toml",
                                     "bluerov2_heavy_survey_dynamics.toml"};

// Bed and wall that all touching missions share.
constexpr const char* kThings =
    "[[objects]]\nname = \"sand\"\nclass = \"seabed\"\nshape = \"box\"\nsize_m = [60, 1, 60]\n"
    "position_m = [0, -12.5, 0]\n"
    "[[objects]]\nname = \"wall\"\nclass = \"rock\"\nshape = \"box\"\nsize_m = [20, 8, 1]\n"
    "position_m = [0, -9, -4]\nyaw_deg = 25\n";

std::string current_text(int kind, const Vec3& v) {
  const std::string velocity =
      fmt::format("velocity_m_s = [{:.3f}, {:.3f}, {:.3f}]\n", v.x, v.y, v.z);
  switch (kind) {
    case 1:
      return "[current]\nkind = \"uniform\"\n" + velocity;
    case 2:
      return "[current]\nkind = \"power_law\"\ndepth_m = 25\n" + velocity;
    case 3:
      return fmt::format(
          "[current]\nkind = \"linear\"\ndepth_m = 20\n{}deep_velocity_m_s = [{:.3f}, 0, {:.3f}]\n",
          velocity, -v.z, v.x);
    default:
      return {};
  }
}

// Uniform in [least, most), a function of the seed, the mission and the question alone.
struct Draw {
  std::uint64_t seed = 0;
  std::size_t mission = 0;
  double operator()(std::uint64_t question, double least, double most) const {
    return least + (most - least) * random_uniform({seed, mission, question}, 0);
  }
};

std::string mission_keys(const Draw& in, bool touches) {
  const std::size_t i = in.mission;
  const std::string speed =
      i % 5 == 4 ? std::string() : fmt::format("speed_m_s = {:.3f}, ", in(1, 0.15, 0.9));
  if (touches)  // down onto the sand, along it, up, and into the wall
    return fmt::format(
        "{}waypoints = [ {{ position_m = [{:.3f}, -11.98, {:.3f}], hold_s = 1 }}, {{ position_m = "
        "[{:.3f}, -9.5, -2] }}, {{ position_m = [{:.3f}, -9.5, -6] }} ]",
        speed.empty() ? "" : fmt::format("speed_m_s = {:.3f}, ", in(1, 0.2, 0.5)), in(2, -0.6, 0.6),
        in(3, -1.2, 0.2), in(4, -0.5, 0.5), in(5, -0.5, 0.5));
  switch (i % 4) {
    case 0:
      return fmt::format(
          "{}waypoints = [ {{ position_m = [{:.3f}, {:.3f}, {:.3f}] }}, {{ position_m = [{:.3f}, "
          "{:.3f}, {:.3f}], hold_s = 2 }}, {{ position_m = [0, -10, 0] }} ], repeat = true",
          speed, in(2, 1, 3), in(3, -11, -9), in(4, -3, -1), in(5, -3, -1), in(6, -11, -8),
          in(7, -2, 2));
    case 1:
      return fmt::format(
          "orbit = {{ point_m = [{:.3f}, -10, {:.3f}], radius_m = {:.3f}, speed_m_s = {:.3f} }}, "
          "look_at_m = [0, -10, -3]",
          in(2, -1, 1), in(3, -4, -2), in(4, 1.5, 3), in(5, 0.15, 0.5));
    case 2:
      return "hold = \"station\"";
    default:
      return fmt::format(
          "{}speed_over = \"{}\", waypoints = [ {{ position_m = [0, {:.3f}, {:.3f}] }}, {{ "
          "position_m = [{:.3f}, {:.3f}, -2], heading_deg = {:.0f} }} ]",
          fmt::format("speed_m_s = {:.3f}, ", in(1, 0.15, 0.9)), i % 8 == 3 ? "ground" : "water",
          in(2, -12, -8), in(3, -5, -2), in(4, -4, 4), in(5, -11, -9), in(6, 0, 360));
  }
}

// A folder of its own, removed with what is in it.
class OwnFolder {
 public:
  static Result<OwnFolder> make() {
    std::error_code error;
    std::string name =
        (std::filesystem::temp_directory_path(error) / "neritic-missions-XXXXXX").string();
    if (error || ::mkdtemp(name.data()) == nullptr)
      return failure(ErrorCode::kIo, "{}: the folder cannot be made", name);
    return OwnFolder(name);
  }
  OwnFolder(OwnFolder&& other) noexcept : path_(std::move(other.path_)) { other.path_.clear(); }
  OwnFolder& operator=(OwnFolder&&) = delete;
  ~OwnFolder() {
    std::error_code ignored;
    if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  explicit OwnFolder(std::filesystem::path path) : path_(std::move(path)) {}
  std::filesystem::path path_;
};

}  // namespace

std::vector<MissionFlight> mission_flights(std::uint64_t seed) {
  std::vector<MissionFlight> out;
  for (std::size_t i = 0; i < 32; ++i) {
    const bool touches = i >= 24;
    const Draw in{seed, i};
    const char* vehicle = kVehicles[i % std::size(kVehicles)];
    const double most_m_s = touches ? 0.2 : 0.45;
    const Vec3 current(in(20, -most_m_s, most_m_s), 0.0, in(21, -most_m_s, most_m_s));
    const int kind = static_cast<int>((i / 2) % 4);
    MissionFlight flight;
    flight.touches = touches;
    flight.name = fmt::format("{} {}{}", i + 1, touches ? "contact " : "",
                              std::string(vehicle).substr(15, 6));
    flight.scene_text =
        current_text(kind, current) + (touches ? kThings : "") +
        fmt::format(
            "[[vehicles]]\nname = \"rov\"\nshape = \"box\"\nsize_m = [0.57, 0.26, 0.46]\n"
            "dynamics = \"vehicles/{}\"\nposition_m = [0, -10, 0]\nyaw_deg = {:.1f}\n"
            "roll_deg = {:.1f}\npitch_deg = {:.1f}\n{}mission = {{ {} }}\n",
            vehicle, in(22, -180, 180), in(23, -12, 12), in(24, -12, 12),
            i % std::size(kVehicles) == 2 ? "navigation = \"truth\"\n" : "",
            mission_keys(in, touches));
    out.push_back(std::move(flight));
  }
  return out;
}

Result<std::vector<Vec3>> flown_path(const MissionFlight& flight,
                                     const std::filesystem::path& assets, double seconds,
                                     const MissionStep& step) {
  NERITIC_TRY(const OwnFolder folder, OwnFolder::make());
  std::error_code error;
  std::filesystem::create_directory_symlink(std::filesystem::absolute(assets, error) / "vehicles",
                                            folder.path() / "vehicles", error);
  const std::filesystem::path file = folder.path() / "mission.toml";
  NERITIC_TRY_STATUS(write_text(file, "[physics]\n" + flight.scene_text));
  NERITIC_TRY(scene::Scene scene, scene::load_scene(file));
  scene.physics->rate_hz = step.hz;
  scene.physics->integrator = step.rk4 ? "rk4" : "guarded";
  scene.physics->max_error_m = step.max_error_m;
  NERITIC_TRY(const auto world, PhysicsWorld::create(scene));
  const auto simulation = world->simulation({.log = false});
  std::vector<Vec3> path;
  const auto steps = static_cast<std::uint64_t>(std::llround(kSample_s / world->step_s()));
  for (double now_s = 0.0; now_s < seconds - 0.5 * kSample_s; now_s += kSample_s) {
    simulation->advance(steps);
    path.push_back(simulation->newest().state.vehicles()[0].body.position_ned_m);
  }
  return path;
}

double most_apart_m(std::span<const Vec3> a, std::span<const Vec3> b) {
  double most_m = 0.0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    most_m = std::max(most_m, glm::distance(a[i], b[i]));
  return most_m;
}

Result<std::vector<MissionError>> fly_missions(std::span<const MissionFlight> flights,
                                               const MissionSweepOptions& options) {
  std::vector<MissionError> out;
  for (const MissionFlight& flight : flights) {
    const double truth_hz = flight.touches ? kTruthInContact_hz : kTruth_hz;
    const auto fly = [&](const MissionStep& step) {
      return flown_path(flight, options.assets, options.seconds, step);
    };
    NERITIC_TRY(const auto truth, fly({truth_hz, true}));
    NERITIC_TRY(const auto less, fly({0.5 * truth_hz, true}));
    MissionError error{flight.name, flight.touches, most_apart_m(truth, less), {}, {}};
    std::vector<MissionStep> steps;
    if (flight.touches)
      for (const double asked_m : kAskedInContact_m) steps.push_back({.max_error_m = asked_m});
    else
      for (const rov::MeasuredRate& rate : rov::measured_rates()) steps.push_back({.hz = rate.hz});
    for (const MissionStep& step : steps) {
      const auto begin = std::chrono::steady_clock::now();
      NERITIC_TRY(const auto path, fly(step));
      const std::chrono::duration<double, std::micro> took =
          std::chrono::steady_clock::now() - begin;
      error.error_m.push_back(most_apart_m(path, truth));
      error.us_a_second.push_back(took.count() / options.seconds);
    }
    out.push_back(std::move(error));
    options.step();
  }
  return out;
}

}  // namespace neritic::tools
