#include "rov/trajectory_cases.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"
#include "rov/bluerov2.hpp"
#include "rov/step.hpp"
#include "rov/thrust_curve.hpp"

namespace neritic::rov {
namespace {

constexpr double kLongest = 1e5;       // s
constexpr double kMostSpeed = 1e3;     // m/s, rad/s
constexpr double kMostSineRate = 1e6;  // rad/s

// step() clamps no input: one beyond most is refused here.
void within(const CaseField& field, std::span<const double> values, double most) {
  if (!std::ranges::all_of(values, [&](double x) { return std::abs(x) <= most; }))
    field.refuse(fmt::format("numbers in [-{0:g}, {0:g}]", most));
}

Vec6 vec6_of(const CaseField& field, double most) {
  const std::vector<double> v = field.numbers(6);
  within(field, v, most);
  Vec6 out;
  std::copy(v.begin(), v.end(), out.v.begin());
  return out;
}

Vec3 vec3_of(const CaseField& field, double most) {
  const Vec3 v = field.vec3(Vec3(0.0));
  within(field, std::array{v.x, v.y, v.z}, most);
  return v;
}

Mat6 matrix6(const CaseField& field) {
  Mat6 out;
  const auto rows = field.rows(6, 6);
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t j = 0; j < 6; ++j) out(i, j) = rows[i][j];
  return out;
}

VehicleParameters read_parameters(const CaseField& field) {
  VehicleParameters p;
  p.mass_kg = field.required("m_kg").number(1.0, 1e-9, 1e9);
  const auto inertia = field.required("I_CO_kgm2").rows(3, 3);
  for (std::size_t i = 0; i < inertia.size(); ++i)
    for (std::size_t j = 0; j < 3; ++j)
      p.inertia_kg_m2[static_cast<int>(j)][static_cast<int>(i)] = inertia[i][j];
  p.gravity_centre_m = field["r_g_m"].vec3(Vec3(0.0));
  p.buoyancy_centre_m = field["r_b_m"].vec3(Vec3(0.0));
  p.weight_n = field["W_N"].number(p.mass_kg * kGravity);
  p.buoyancy_n = field["B_N"].number(p.weight_n);
  p.added_mass = matrix6(field["M_A"]);
  p.linear_damping = matrix6(field["D_L"]);
  p.quadratic_damping = vec6_of(field["D_Q_diag"], kMostForce);
  return p;
}

std::vector<Thruster> read_thrusters(const CaseField& field) {
  if (!field["position_frd_m"].present() && !field["direction_frd"].present()) {
    std::vector<Thruster> out = heavy_thrusters();
    for (Thruster& t : out) t = {t.position_m, t.direction};  // no limits: forces are given
    return out;
  }
  const auto positions = field.required("position_frd_m").rows(0, 3);
  const auto directions = field.required("direction_frd").rows(positions.size(), 3);
  std::vector<Thruster> out;
  for (std::size_t i = 0; i < std::min(positions.size(), directions.size()); ++i) {
    const auto &p = positions[i], &d = directions[i];
    out.push_back({{p[0], p[1], p[2]}, {d[0], d[1], d[2]}});
  }
  return out;
}

std::optional<SineWrench> read_sine(const CaseField& field) {
  if (!field.present()) return std::nullopt;
  SineWrench out;
  field.allow_with_texts({"A", "omega", "phase"});
  out.amplitude = vec6_of(field.required("A"), kMostForce);
  out.rad_s = vec6_of(field.required("omega"), kMostSineRate);
  out.phase_rad = vec6_of(field.required("phase"), kMostSineRate);
  return out;
}

// Sets how the thrusters follow their commands; false where the case has none.
bool read_mode(const CaseField& scenario, ThrusterLag& lag) {
  const std::string mode = scenario["thruster_mode"].text("none");
  if (mode == "lag1") {
    lag.kind = ThrusterLag::Kind::kFirstOrder;
    lag.time_s = scenario.required("thruster_time_constant_s").number(1.0, 1e-6, 1e6);
  } else if (mode == "vb3") {
    lag.kind = ThrusterLag::Kind::kThirdOrder;
  } else if (mode != "none" && mode != "force" && mode != "vb_poly" && mode != "t200_16V") {
    scenario["thruster_mode"].refuse("none, force, lag1, vb3, vb_poly or t200_16V");
  }
  return mode != "none";
}

// The forces of the thrusters in a segment: given, or computed from its inputs.
std::vector<double> read_forces(const CaseField& scenario, std::size_t segment, std::size_t count,
                                const std::filesystem::path& folder) {
  const CaseField given = scenario["input_segments"].at(segment)["thruster_force_cmd_N"];
  if (given.present()) {
    const std::vector<double> forces = given.numbers(count);
    within(given, forces, kMostForce);
    return forces;
  }
  if (const CaseField volts = scenario["input_normalised_V"]; volts.present()) {
    std::vector<double> forces = volts.at(segment).required_numbers(count);
    std::ranges::transform(forces, forces.begin(), von_benzon_thrust_n);
    return forces;
  }
  const CaseField pulses = scenario["input_pwm_us"];
  if (!pulses.present()) return {};
  const auto curve = ThrustCurve::read(folder / "t200_thrust.csv");
  if (!curve.ok()) {
    pulses.fail(curve.error().message);
    return {};
  }
  std::vector<double> forces = pulses.at(segment).required_numbers(count);
  for (double& force : forces) force = curve->thrust_n(force, 16.0);
  return forces;
}

void read_segments(const CaseField& scenario, bool thrust, const std::filesystem::path& folder,
                   TrajectoryCase& out) {
  const CaseField list = scenario["input_segments"];
  for (std::size_t i = 0; i < list.size(); ++i) {
    const CaseField at = list.at(i);
    at.allow_with_texts({"t0", "t1", "tau_body", "thruster_force_cmd_N"});
    InputSegment segment;
    segment.t0_s = at.required("t0").number(0.0, 0.0, kLongest);
    segment.t1_s = at.required("t1").number(0.0, 0.0, kLongest);
    if (!(segment.t1_s > segment.t0_s)) at["t1"].refuse("a time after t0");
    if (!out.segments.empty() && segment.t0_s < out.segments.back().t1_s)
      at["t0"].refuse("a time not before the last segment's t1");
    segment.wrench = vec6_of(at["tau_body"], kMostForce);
    const auto forces = read_forces(scenario, i, out.vehicle.thruster_count, folder);
    if (thrust) std::ranges::copy(forces, segment.thruster_n.begin());
    out.segments.push_back(segment);
  }
}

std::optional<Quat> read_attitude(const CaseField& field) {
  const std::vector<double> q = field.numbers(4);
  if (q.empty()) return std::nullopt;
  const Quat out(q[0], q[1], q[2], q[3]);
  const double length = glm::length(out);
  if (!(length > 0.5 && length < 2.0)) {
    field.refuse("a unit quaternion [w, x, y, z]");
    return std::nullopt;
  }
  return out / length;
}

void read_samples(const CaseField& scenario, TrajectoryCase& out) {
  const CaseField list = scenario.required("samples");
  for (std::size_t i = 0; i < list.size(); ++i) {
    const CaseField at = list.at(i);
    at.allow_with_texts({"t", "p_ned", "q_wxyz", "nu_frd", "thruster_force_N"});
    TrajectorySample sample;
    sample.t_s = at.required("t").number(0.0, 0.0, kLongest);
    if (!out.samples.empty() && !(sample.t_s > out.samples.back().t_s))
      at["t"].refuse("a time after the last sample's");
    if (at["p_ned"].present()) sample.position_ned_m = at["p_ned"].vec3(Vec3(0.0));
    sample.attitude = read_attitude(at["q_wxyz"]);
    if (at["nu_frd"].present()) sample.velocity = vec6_of(at["nu_frd"], kMostForce);
    sample.thruster_n = at["thruster_force_N"].present()
                            ? at["thruster_force_N"].numbers(out.vehicle.thruster_count)
                            : std::vector<double>();
    if (!sample.position_ned_m && !sample.attitude && !sample.velocity && sample.thruster_n.empty())
      at.fail(found_accepted("nothing to compare", "p_ned, q_wxyz, nu_frd or thruster_force_N"));
    out.samples.push_back(std::move(sample));
  }
  if (out.samples.empty()) list.fail(found_accepted("none", "at least one sample"));
}

// "rk4_240Hz": [position, velocity]; null where that integrator diverged.
void read_promises(const CaseField& field, TrajectoryCase& out) {
  for (const std::string& key : field.keys()) {
    const CaseField pair = field[key];
    if (pair.is_text()) continue;
    const std::string_view name = key;
    const auto cut = name.rfind('_');
    const std::string_view integrator = name.substr(0, cut);
    const bool known = cut != name.npos && (integrator == "rk4" || integrator == "semi_euler");
    const auto hz = known && name.ends_with("Hz")
                        ? parse_number(name.substr(cut + 1, name.size() - cut - 3))
                        : std::nullopt;
    if (!hz || !(*hz > 0.0 && *hz < 1e9)) {
      pair.fail(
          found_accepted("another name", "rk4_ or semi_euler_, a rate and Hz, such as rk4_240Hz"));
      return;
    }
    if (pair.size() != 2) pair.refuse("[position, velocity], each a number or null");
    if (!pair.at(0).present() || !pair.at(1).present()) continue;
    out.promised.push_back(
        {std::string(integrator), *hz, pair.at(0).number(0.0), pair.at(1).number(0.0)});
  }
}

TrajectoryCase read_case(CaseFile& file, const CaseField& scenario, const CaseField& thrusters,
                         const std::filesystem::path& folder) {
  scenario.allow_with_texts({"id", "params", "current_ned_mps", "initial", "thruster_mode",
                             "thruster_time_constant_s", "input_segments", "input_normalised_V",
                             "input_pwm_us", "tau_sin", "samples", "reference_error_estimate",
                             "fixed_step_end_error", "quat_norm_error", "closed_form"});
  scenario["params"].allow_with_texts(
      {"m_kg", "I_CO_kgm2", "r_g_m", "r_b_m", "W_N", "B_N", "M_A", "D_L", "D_Q_diag"});
  scenario["initial"].allow_with_texts({"p_ned", "q_wxyz", "nu_frd"});
  TrajectoryCase out;
  VehicleParameters parameters = read_parameters(scenario.required("params"));
  const bool thrust = read_mode(scenario, parameters.lag);
  parameters.thrusters = read_thrusters(thrusters);
  if (file.failed()) return out;
  Result<Vehicle> vehicle = make_vehicle(parameters);
  if (!vehicle.ok()) {
    scenario["params"].fail(vehicle.error().message);
    return out;
  }
  out.vehicle = *vehicle;
  out.current_ned_m_s = vec3_of(scenario["current_ned_mps"], kMostCurrent_m_s);
  const CaseField initial = scenario["initial"];
  out.position_ned_m = vec3_of(initial["p_ned"], kMostForce);
  out.attitude = read_attitude(initial["q_wxyz"]).value_or(Quat(1.0, 0.0, 0.0, 0.0));
  out.velocity = vec6_of(initial["nu_frd"], kMostSpeed);
  out.sine = read_sine(scenario["tau_sin"]);
  read_segments(scenario, thrust, folder, out);
  read_samples(scenario, out);
  read_promises(scenario["fixed_step_end_error"], out);
  out.reference_error = scenario["reference_error_estimate"].number(0.0, 0.0, 1.0);
  return out;
}

}  // namespace

Result<std::vector<TrajectoryCase>> read_trajectories(std::string_view text,
                                                      const std::string& name,
                                                      const std::filesystem::path& folder) {
  NERITIC_TRY(CaseFile file, CaseFile::parse(text, name));
  const CaseField root = file.root();
  if (root["format"].present() && root["format"].text() != "rov_vectors/1")
    root["format"].refuse("\"rov_vectors/1\"");
  root.allow_with_texts(
      {"format", "conventions", "equations", "thrusters", "sources", "scenarios"});
  root["thrusters"].allow_with_texts(
      {"position_frd_m", "direction_frd", "allocation_6x8", "pinv_8x6"});
  const CaseField list = root.required("scenarios");
  std::vector<TrajectoryCase> out;
  for (std::size_t i = 0; i < list.size() && !file.failed(); ++i) {
    const CaseField scenario = list.at(i);
    const std::string id = scenario["id"].text(fmt::format("case {}", i + 1));
    file.enter_case(id);
    TrajectoryCase one = read_case(file, scenario, root["thrusters"], folder);
    one.id = id;
    out.push_back(std::move(one));
  }
  file.enter_case("");
  if (list.present() && out.empty()) list.fail(found_accepted("none", "at least one case"));
  if (file.failed()) return file.error();
  return out;
}

}  // namespace neritic::rov
