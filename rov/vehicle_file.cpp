// See vehicle_file.hpp.
#include "rov/vehicle_file.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/case_toml.hpp"
#include "engine/core/files.hpp"
#include "engine/core/refusal.hpp"
#include "rov/bluerov2.hpp"
#include "rov/sensor_file.hpp"
#include "rov/ventilation.hpp"

namespace neritic::rov {
namespace {

constexpr std::string_view kVehicleKeys[] = {"name",
                                             "mass_kg",
                                             "gravity_m_s2",
                                             "inertia_kg_m2",
                                             "gravity_centre_m",
                                             "buoyancy_centre_m",
                                             "weight_n",
                                             "volume_m3",
                                             "buoyancy_n",
                                             "added_mass",
                                             "linear_damping",
                                             "quadratic_damping",
                                             "thrusters",
                                             "lag",
                                             "thrust_table",
                                             "voltage_v",
                                             "tether",
                                             "battery",
                                             "outline",
                                             "control",
                                             "imu",
                                             "dvl",
                                             "pressure",
                                             "compass",
                                             "altimeter",
                                             "usbl"};
constexpr std::string_view kPathKeys[] = {"thrust_table"};
constexpr std::string_view kLagKeys[] = {"kind", "time_s", "a2", "a1", "a0", "b1"};
constexpr std::string_view kThrusterKeys[] = {"name",  "position_m", "direction",
                                              "min_n", "max_n",      "propeller_m"};
constexpr std::string_view kTetherKeys[] = {"attachment_m",   "length_m",        "diameter_m",
                                            "net_weight_n_m", "stiffness_n",     "damping_n_s",
                                            "normal_drag",    "tangential_drag", "water_kg_m3"};
constexpr std::string_view kBatteryKeys[] = {"capacity_wh",    "full_v",  "empty_v",
                                             "resistance_ohm", "hotel_w", "propeller_m",
                                             "efficiency",     "charge"};
constexpr std::string_view kControlKeys[] = {
    "kp", "ki", "kd", "u_max", "i_max", "zone", "rate_hz", "saturation", "feed_forward"};

Mat6 matrix_of(const CaseField& field) {
  Mat6 out;
  const auto rows = field.square(6);
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t j = 0; j < 6; ++j) out(i, j) = rows[i][j];
  return out;
}

// Symmetric, and never giving energy: within rounding of positive semidefinite.
void check_dissipation(const CaseField& file, const VehicleParameters& p) {
  if (symmetric_part(p.added_mass) != p.added_mass)
    file["added_mass"].fail(found_accepted("an asymmetric matrix", "a symmetric one"));
  Mat6 lifted = symmetric_part(p.linear_damping);
  for (std::size_t i = 0; i < 6; ++i) lifted(i, i) += 1e-12 + 1e-12 * lifted(i, i);
  if (!(smallest_pivot(lifted) > -1e-9))
    file["linear_damping"].fail(
        found_accepted("a matrix that adds energy", "a positive semidefinite one"));
}

void read_body(const CaseField& file, double water_kg_m3, double gravity, VehicleParameters& p) {
  p.name = file["name"].text();
  p.mass_kg = file.required("mass_kg").number(1.0, 1e-6, 1e9);
  const auto inertia = file.required("inertia_kg_m2").square(3);
  for (std::size_t i = 0; i < inertia.size(); ++i)
    for (std::size_t j = 0; j < 3; ++j)
      p.inertia_kg_m2[static_cast<int>(j)][static_cast<int>(i)] = inertia[i][j];
  p.gravity_centre_m = file["gravity_centre_m"].vec3(Vec3(0.0));
  p.buoyancy_centre_m = file["buoyancy_centre_m"].vec3(Vec3(0.0));
  p.weight_n = file["weight_n"].number(p.mass_kg * gravity, 0.0, 1e9);
  const CaseField volume = file["volume_m3"];
  const double displaced = volume.number(0.0, 0.0, 1e6) * water_kg_m3 * gravity;
  p.buoyancy_n = file["buoyancy_n"].number(volume.present() ? displaced : p.weight_n, 0.0, 1e9);
  p.added_mass = matrix_of(file["added_mass"]);
  p.linear_damping = matrix_of(file["linear_damping"]);
  std::ranges::copy(file["quadratic_damping"].numbers(6), p.quadratic_damping.v.begin());
  check_dissipation(file, p);
}

void read_lag(const CaseField& field, ThrusterLag& lag) {
  field.allow(kLagKeys);
  const std::string kind = field["kind"].text("third_order");
  if (kind == "third_order")
    lag.kind = ThrusterLag::Kind::kThirdOrder;
  else if (kind == "first_order")
    lag.kind = ThrusterLag::Kind::kFirstOrder;
  else if (kind != "none")
    field["kind"].refuse("none, first_order or third_order");
  lag.time_s = field["time_s"].number(lag.time_s, 1e-6, 1e6);
  lag.a2 = field["a2"].number(lag.a2, 0.0, 1e9);
  lag.a1 = field["a1"].number(lag.a1, 0.0, 1e15);
  lag.a0 = field["a0"].number(lag.a0, 0.0, 1e18);
  lag.b1 = field["b1"].number(lag.b1, -1e15, 1e15);
}

void read_thrusters(const CaseField& list, VehicleParameters& p) {
  for (std::size_t i = 0; i < list.size(); ++i) {
    const CaseField at = list.at(i);
    at.allow(kThrusterKeys);
    Thruster thruster;
    thruster.position_m = at.required("position_m").vec3(Vec3(0.0));
    const Vec3 direction = at.required("direction").vec3(Vec3(1.0, 0.0, 0.0));
    const double length = glm::length(direction);
    if (length > 1e-6 && length < 1e6)
      thruster.direction = direction / length;
    else
      at["direction"].refuse("a vector that is not 0");
    thruster.min_n = at["min_n"].number(thruster.min_n, -1e9, 0.0);
    thruster.max_n = at["max_n"].number(thruster.max_n, 0.0, 1e9);
    thruster.propeller_m = at["propeller_m"].number(
        p.battery ? p.battery->propeller_m : thruster.propeller_m, 0.0, kLargestPropeller_m);
    p.thrusters.push_back(thruster);
  }
}

void read_tether(const CaseField& field, Tether& tether) {
  field.allow(kTetherKeys);
  tether.attachment_m = field["attachment_m"].vec3(tether.attachment_m);
  const std::pair<const char*, double Tether::*> numbers[] = {
      {"length_m", &Tether::length_m},
      {"diameter_m", &Tether::diameter_m},
      {"net_weight_n_m", &Tether::net_weight_n_m},
      {"stiffness_n", &Tether::stiffness_n},
      {"damping_n_s", &Tether::damping_n_s},
      {"normal_drag", &Tether::normal_drag},
      {"tangential_drag", &Tether::tangential_drag},
      {"water_kg_m3", &Tether::water_kg_m3}};
  for (const auto& [key, member] : numbers) tether.*member = field[key].number(tether.*member);
}

void read_battery(const CaseField& field, Battery& battery) {
  field.allow(kBatteryKeys);
  const std::pair<const char*, double Battery::*> numbers[] = {
      {"capacity_wh", &Battery::capacity_wh}, {"full_v", &Battery::full_v},
      {"empty_v", &Battery::empty_v},         {"resistance_ohm", &Battery::resistance_ohm},
      {"hotel_w", &Battery::hotel_w},         {"propeller_m", &Battery::propeller_m},
      {"efficiency", &Battery::efficiency},   {"charge", &Battery::charge}};
  for (const auto& [key, member] : numbers) battery.*member = field[key].number(battery.*member);
}

void read_gains(const CaseField& field, ControlGains& gains) {
  field.allow(kControlKeys);
  const std::pair<const char*, double PidAxis::*> lists[] = {
      {"kp", &PidAxis::kp},       {"ki", &PidAxis::ki},       {"kd", &PidAxis::kd},
      {"u_max", &PidAxis::u_max}, {"i_max", &PidAxis::i_max}, {"zone", &PidAxis::zone}};
  for (const auto& [key, member] : lists) {
    const auto values = field[key].numbers(6);
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!(values[i] >= 0.0)) field[key].refuse("numbers from 0");
      gains.axes[i].*member = values[i];
    }
  }
  gains.period_s = 1.0 / field["rate_hz"].number(1.0 / gains.period_s, 1.0, 1e4);
  const std::string saturation = field["saturation"].text("scale");
  if (saturation == "redistribute")
    gains.saturation = Saturation::kRedistribute;
  else if (saturation != "scale")
    field["saturation"].refuse("scale or redistribute");
  gains.feed_forward = field["feed_forward"].boolean(false);
}

}  // namespace

Result<VehicleFile> parse_vehicle(std::string_view text, const std::string& name,
                                  const std::filesystem::path& folder, double water_kg_m3) {
  NERITIC_TRY(CaseFile file, parse_case_toml(text, name, folder, kPathKeys));
  const CaseField root = file.root();
  root.allow(kVehicleKeys);
  VehicleFile out;
  VehicleParameters& p = out.parameters;
  out.gravity_m_s2 = root["gravity_m_s2"].number(kGravity, 0.0, 100.0);
  read_body(root, water_kg_m3, out.gravity_m_s2, p);
  if (root["lag"].present()) read_lag(root["lag"], p.lag);
  if (root["tether"].present()) {
    p.tether = Tether{.water_kg_m3 = water_kg_m3};
    read_tether(root["tether"], *p.tether);
  }
  if (root["battery"].present()) {
    p.battery = Battery{.water_kg_m3 = water_kg_m3};
    read_battery(root["battery"], *p.battery);
  }
  read_thrusters(root["thrusters"], p);
  out.gains = default_gains();
  if (root["control"].present()) read_gains(root["control"], out.gains);
  out.voltage_v = root["voltage_v"].number(16.0, 1.0, 1000.0);
  out.sensors = read_sensors(root, out.gravity_m_s2);
  out.outline = read_outline(root["outline"]);
  const std::string curve = root["thrust_table"].text();
  if (file.failed()) return file.error();
  if (!curve.empty()) {
    Result<ThrustCurve> read = ThrustCurve::read(curve);
    if (!read.ok())
      return bad_input(
          "{}: thrust_table: {}{}", name, read.error().message,
          read.error().message.find("accepted: ") == std::string::npos
              ? "; accepted: a .csv of pulse widths and newtons, pwm_us,thrust_n_16v,..."
              : "");
    out.curve = std::move(read).value();
  }
  const Result<Vehicle> vehicle = make_vehicle(p);
  if (!vehicle.ok()) return bad_input("{}: {}", name, vehicle.error().message);
  return out;
}

Result<VehicleFile> read_vehicle(const std::filesystem::path& path, double water_kg_m3) {
  NERITIC_TRY(const std::string text, read_text(path));
  return parse_vehicle(text, path.string(), path.parent_path(), water_kg_m3);
}

void drive(const VehicleFile& file, Inputs& inputs, const BatteryState* battery) {
  const std::size_t count = file.parameters.thrusters.size();
  if (battery != nullptr && battery->empty != 0) {
    std::fill_n(inputs.thruster_n.begin(), count, 0.0);
    return;
  }
  if (!file.curve) return;
  const double voltage_v = battery != nullptr ? battery->voltage_v : file.voltage_v;
  for (std::size_t i = 0; i < count; ++i)
    inputs.thruster_n[i] = file.curve->realised_n(inputs.thruster_n[i], voltage_v);
}

std::pair<double, double> thruster_limits_n(const VehicleFile& file, std::size_t thruster) {
  constexpr double kAny_n = 1e9;
  if (file.curve)
    return {file.curve->realised_n(-kAny_n, file.voltage_v),
            file.curve->realised_n(kAny_n, file.voltage_v)};
  const Thruster& limits = file.parameters.thrusters[thruster];
  return {limits.min_n, limits.max_n};
}

}  // namespace neritic::rov
