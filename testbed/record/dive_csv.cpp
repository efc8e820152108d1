#include "testbed/record/dive_csv.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>

#include "rov/frames.hpp"

namespace neritic::testbed {
namespace {

struct EulerAngles {
  double heading_rad, pitch_rad, roll_rad;
};

// The angles of an attitude in marine axes: heading, then pitch, then roll (Fossen 2011, eq. 2.45).
EulerAngles euler_of(const Quat& q) {
  return {rov::heading_of(q), std::asin(std::clamp(2.0 * (q.w * q.y - q.z * q.x), -1.0, 1.0)),
          std::atan2(2.0 * (q.w * q.x + q.y * q.z), 1.0 - 2.0 * (q.x * q.x + q.y * q.y))};
}

// Headings from 0 to 360.
double compass_deg(double heading_rad) {
  const double deg = degrees(heading_rad);
  return deg < 0.0 ? deg + 360.0 : deg;
}

constexpr const char* kColumns =
    "time_s,vehicle,x_m,y_m,z_m,depth_m,qw,qx,qy,qz,heading_deg,pitch_deg,roll_deg,surge_m_s,"
    "sway_m_s,heave_m_s,roll_deg_s,pitch_deg_s,yaw_deg_s,current_x_m_s,current_y_m_s,current_z_m_s,"
    "wanted_x_m,wanted_y_m,wanted_z_m,wanted_heading_deg,error_m,waypoint,arrived,near_points,"
    "touched_steps";

void append_numbers(std::string& out, std::initializer_list<double> numbers) {
  for (const double number : numbers) fmt::format_to(std::back_inserter(out), ",{:.9g}", number);
}

constexpr const char* kHumanColumns =
    ",tank,tank_bar,remaining_min,ventilation_l_min,breaths_min,lungs_l,jacket_l,net_weight_n,"
    "buttons,kick_hz,limb_power_w,oxygen_l_min,reserve_percent,ceiling_m,no_stop_min,stop_m,stop_"
    "min,"
    "to_surface_min,po2_bar,gas_density_g_l,cns_percent,otu,ascent_m_min,ascent_alarm,ceiling_"
    "violated,"
    "heart_bpm,"
    "pause_s,gaze_x,gaze_y,gaze_z,measured,co2_proxy_mmhg,narcosis_proxy_m,co2_risk,narcosis_risk,"
    "density_risk,breathing_risk,oxygen_risk,out_of_gas_s,ascent_gas_l,ascent_gas_there_l,tanks_"
    "too_small";

// A number that is not finite (no end of breath in sight) is an empty cell.
void append_cells(std::string& out, std::span<const double> numbers) {
  for (const double number : numbers) {
    out += ',';
    if (std::isfinite(number)) fmt::format_to(std::back_inserter(out), "{:.9g}", number);
  }
}

void append_empty(std::string& out, std::ptrdiff_t cells) {
  out.append(static_cast<std::size_t>(cells), ',');
}

std::ptrdiff_t cells_of(const char* names) {
  return std::count(names, names + std::strlen(names), ',');
}

// A sensor's columns: each name with a comma before it, and its newest reading's numbers.
struct SensorColumns {
  const char* names;
  bool (*has)(const rov::SensorSet& sensors);
  std::uint64_t (*count)(const rov::SensorReadings& readings);
  std::vector<double> (*numbers)(const rov::SensorReadings& readings);
};
using Set = rov::SensorSet;
using Readings = rov::SensorReadings;
using Numbers = std::vector<double>;

constexpr double kNotHeard = std::numeric_limits<double>::quiet_NaN();  // an empty cell

Numbers imu_numbers(const Readings& r) {
  const Vec3 &w = r.imu.value.angular_rad_s, &a = r.imu.value.specific_force_m_s2;
  return {degrees(w.x), degrees(w.y), degrees(w.z), a.x, a.y, a.z};
}
Numbers dvl_numbers(const Readings& r) {
  const rov::DvlReading& dvl = r.dvl.value;
  const Vec3 v = dvl.locked() ? dvl.velocity_m_s : Vec3(kNotHeard);
  return {v.x, v.y, v.z, dvl.heard != 0 ? dvl.altitude_m : kNotHeard};
}
Numbers pressure_numbers(const Readings& r) {
  return {r.pressure.value.pressure_pa, r.pressure.value.depth_m};
}
Numbers compass_numbers(const Readings& r) {
  return {degrees(r.heading_rad.value)};
}
Numbers altimeter_numbers(const Readings& r) {
  return {r.altimeter.value.heard != 0 ? r.altimeter.value.distance_m : kNotHeard};
}
Numbers usbl_numbers(const Readings& r) {
  if (r.usbl.value.heard == 0) return {kNotHeard, kNotHeard, kNotHeard};
  const Vec3 p = rov::world_from_ned(r.usbl.value.position_ned_m);
  return {p.x, p.y, p.z};
}

const SensorColumns kSensorColumns[] = {
    {",gyro_roll_deg_s,gyro_pitch_deg_s,gyro_yaw_deg_s,accelerometer_x_m_s2,accelerometer_y_m_s2,"
     "accelerometer_z_m_s2",
     [](const Set& s) { return s.imu.has_value(); }, [](const Readings& r) { return r.imu.count; },
     imu_numbers},
    {",dvl_surge_m_s,dvl_sway_m_s,dvl_heave_m_s,dvl_altitude_m",
     [](const Set& s) { return s.dvl.has_value(); }, [](const Readings& r) { return r.dvl.count; },
     dvl_numbers},
    {",pressure_pa,pressure_depth_m", [](const Set& s) { return s.pressure.has_value(); },
     [](const Readings& r) { return r.pressure.count; }, pressure_numbers},
    {",compass_deg", [](const Set& s) { return s.compass.has_value(); },
     [](const Readings& r) { return r.heading_rad.count; }, compass_numbers},
    {",altimeter_m", [](const Set& s) { return s.altimeter.has_value(); },
     [](const Readings& r) { return r.altimeter.count; }, altimeter_numbers},
    {",usbl_x_m,usbl_y_m,usbl_z_m", [](const Set& s) { return s.usbl.has_value(); },
     [](const Readings& r) { return r.usbl.count; }, usbl_numbers}};

bool any_has(const PhysicsWorld& world, const SensorColumns& sensor) {
  return std::ranges::any_of(world.vehicles(), [&](const PhysicsVehicle& vehicle) {
    return sensor.has(vehicle.file.sensors);
  });
}

// Empty cells where there is no reading.
void append_readings(std::string& out, const SensorColumns& sensor, const Readings* readings) {
  const auto columns = cells_of(sensor.names);
  const bool any = readings && sensor.count(*readings) > 0;
  const Numbers numbers =
      any ? sensor.numbers(*readings) : Numbers(static_cast<std::size_t>(columns), kNotHeard);
  append_cells(out, numbers);
}

// For vehicles that fly by their own sensors: their estimated position, as x_m to
// heave_m_s, and standard deviations about the world's axes.
constexpr const char* kEstimateColumns =
    ",estimated_x_m,estimated_y_m,estimated_z_m,estimated_heading_deg,estimated_pitch_deg,"
    "estimated_"
    "roll_deg,estimated_surge_m_s,estimated_sway_m_s,estimated_heave_m_s,sigma_x_m,sigma_y_m,sigma_"
    "z_m,sigma_vx_m_s,sigma_vy_m_s,sigma_vz_m_s,sigma_about_x_deg,sigma_about_y_deg,sigma_about_z_"
    "deg,navigation_error_m";

// Columns of vehicles with a tether of the scene.
constexpr const char* kTetherColumns =
    ",tether_n,tether_top_n,tether_most_n,tether_m,tether_straight_m,tether_touching,tether_x_n,"
    "tether_y_n,tether_z_n";

void append_tether(std::string& out, const std::optional<TetherState>& tether) {
  if (!tether) return append_empty(out, cells_of(kTetherColumns));
  const Vec3 pull = rov::world_from_ned(tether->pull_ned_n);
  append_numbers(out, {tether->end_n, tether->top_n, tether->most_n, tether->length_m,
                       glm::distance(tether->top_ned_m, tether->end_ned_m),
                       static_cast<double>(tether->touching), pull.x, pull.y, pull.z});
}

bool any_navigates(const PhysicsWorld& world) {
  return std::ranges::any_of(world.vehicles(), [](const PhysicsVehicle& vehicle) {
    return vehicle.navigation.has_value();
  });
}

void append_estimate(std::string& out, const DiveRow& row) {
  if (!row.estimate) return append_empty(out, cells_of(kEstimateColumns));
  const rov::NavigationEstimate& e = *row.estimate;
  const Vec3 p = rov::world_from_ned(e.position_ned_m);
  const Vec3 v = glm::conjugate(e.attitude) * e.velocity_ned_m_s;
  const auto [heading, pitch, roll] = euler_of(e.attitude);
  append_numbers(out, {p.x, p.y, p.z, compass_deg(heading), degrees(pitch), degrees(roll)});
  append_numbers(out, {v.x, v.y, v.z});
  // x east, y up, z south.
  for (const auto& [sigma, unit] :
       {std::pair(e.position_sigma_m, 1.0), std::pair(e.velocity_sigma_m_s, 1.0),
        std::pair(e.attitude_sigma_rad, degrees(1.0))})
    append_numbers(out, {unit * sigma.y, unit * sigma.z, unit * sigma.x});
  append_numbers(out, {glm::distance(p, row.world_from_body.position_m)});
}

// Columns x_m to wanted_z_m. Velocity: body axes forward, starboard, down; the rest: world axes.
void append_motion(std::string& out, const Pose& world_from_body, const Vec6& velocity,
                   const Vec3& current_m_s, const Vec3& wanted_m) {
  const Vec3& p = world_from_body.position_m;
  const Quat& q = world_from_body.rotation;
  const auto [heading, pitch, roll] = euler_of(rov::ned_from_world(q));
  append_numbers(out, {p.x, p.y, p.z, -p.y, q.w, q.x, q.y, q.z});
  append_numbers(out, {compass_deg(heading), degrees(pitch), degrees(roll)});
  append_numbers(out, {velocity[0], velocity[1], velocity[2]});
  append_numbers(out, {degrees(velocity[3]), degrees(velocity[4]), degrees(velocity[5])});
  append_numbers(out, {current_m_s.x, current_m_s.y, current_m_s.z});
  append_numbers(out, {wanted_m.x, wanted_m.y, wanted_m.z});
}

}  // namespace

struct DiveCsv::Columns {
  std::size_t thrusters = 0;
  std::vector<std::size_t> sensors;  // of kSensorColumns
  bool estimate = false, tether = false, humans = false, silent = false;
};

DiveCsv::DiveCsv(const PhysicsWorld& world) : world_(world) {
  auto columns = std::make_unique<Columns>();
  for (const PhysicsVehicle& vehicle : world.vehicles())
    columns->thrusters = std::max<std::size_t>(columns->thrusters, vehicle.vehicle.thruster_count);
  for (std::size_t i = 0; i < std::size(kSensorColumns); ++i)
    if (any_has(world, kSensorColumns[i])) columns->sensors.push_back(i);
  columns->estimate = any_navigates(world);
  columns->tether = world.tethers().any();
  columns->humans = !world.humans().empty();
  columns->silent = !world.sources().empty();
  columns_ = std::move(columns);
}

DiveCsv::~DiveCsv() = default;

void DiveCsv::append_end(std::string& out, std::uint64_t silent, std::uint64_t hash) const {
  if (columns_->silent) fmt::format_to(std::back_inserter(out), ",{}", silent);
  fmt::format_to(std::back_inserter(out), ",{:016x}\n", hash);
}

void DiveCsv::append(std::string& out, const DiveRow& row) const {
  const PhysicsVehicle& vehicle = world_.vehicles()[row.vehicle];
  const Vec3& p = row.world_from_body.position_m;
  fmt::format_to(std::back_inserter(out), "{:.9g},{}", row.time_s, vehicle.name);
  append_motion(out, row.world_from_body, row.velocity, row.current_m_s, row.wanted.position_m);
  append_numbers(out, {compass_deg(rov::heading_of(rov::ned_from_world(row.wanted.rotation))),
                       glm::distance(p, row.wanted.position_m)});
  fmt::format_to(std::back_inserter(out), ",{},{},{},{}", row.waypoint, row.arrived,
                 row.near_points, row.touched_steps);
  for (std::size_t i = 0; i < columns_->thrusters; ++i) {
    if (i < vehicle.vehicle.thruster_count)
      append_numbers(out, {row.command_n[i], row.force_n[i]});
    else
      out += ",,";
  }
  for (const std::size_t i : columns_->sensors) {
    const SensorColumns& sensor = kSensorColumns[i];
    append_readings(out, sensor, sensor.has(vehicle.file.sensors) ? &row.readings : nullptr);
  }
  if (columns_->estimate) append_estimate(out, row);
  if (columns_->tether) append_tether(out, row.tether);
  if (columns_->humans) append_empty(out, cells_of(kHumanColumns));
  append_end(out, row.silent, row.hash);
}

void DiveCsv::append(std::string& out, const HumanRow& row) const {
  const Vec3& p = row.world_from_body.position_m;
  const Vec3 wanted = rov::world_from_ned(row.goal.target_ned_m);
  fmt::format_to(std::back_inserter(out), "{:.9g},{}", row.time_s, world_.humans()[row.human].name);
  append_motion(out, row.world_from_body, row.velocity, row.current_m_s, wanted);
  fmt::format_to(std::back_inserter(out), ",,{:.9g},{},{},{},{}", glm::distance(p, wanted),
                 row.arrived, row.arrived, row.near_points, row.touched_steps);
  append_empty(out, static_cast<std::ptrdiff_t>(2 * columns_->thrusters));
  for (const std::size_t i : columns_->sensors)
    append_empty(out, cells_of(kSensorColumns[i].names));
  if (columns_->estimate) append_empty(out, cells_of(kEstimateColumns));
  if (columns_->tether) append_empty(out, cells_of(kTetherColumns));
  const diver::GasReading& gas = row.gas;
  const diver::DiveComputerView& deco = row.ascent.view;
  const diver::VitalState& vitals = row.vitals;
  const diver::RiskProxies& risk = vitals.risk;
  const Vec3 gaze = rov::world_from_ned(vitals.gaze_ned);
  const double cells[] = {static_cast<double>(row.tank),
                          1e-5 * gas.tank_pa,
                          gas.remaining_s / 60.0,
                          gas.ventilation_l_min,
                          gas.breaths_min,
                          1e3 * row.lungs_m3,
                          1e3 * gas.jacket_m3,
                          row.net_weight_n,
                          static_cast<double>(row.buttons),
                          row.kick_hz,
                          row.limb_power_w,
                          row.oxygen_l_min,
                          100.0 * row.reserve_share,
                          deco.ceiling_m,
                          deco.no_stop_min,
                          deco.stop_m,
                          deco.stop_min,
                          deco.to_surface_min,
                          deco.po2_bar,
                          deco.density_g_l,
                          row.cns_percent,
                          row.otu,
                          deco.ascent_m_min,
                          static_cast<double>(deco.alarm),
                          deco.ceiling_violated ? 1.0 : 0.0,
                          vitals.heart_bpm,
                          vitals.pause_s,
                          gaze.x,
                          gaze.y,
                          gaze.z,
                          static_cast<double>(vitals.measured),
                          risk.co2_mmhg,
                          risk.narcotic_depth_m,
                          static_cast<double>(risk.co2),
                          static_cast<double>(risk.narcosis),
                          static_cast<double>(risk.gas_density),
                          static_cast<double>(risk.breathing),
                          static_cast<double>(risk.oxygen),
                          row.out_of_gas_s,
                          row.ascent.needed_l,
                          row.ascent.there_l,
                          static_cast<double>(row.ascent.too_small)};
  append_cells(out, cells);
  append_end(out, row.silent, row.hash);
}

std::string DiveCsv::heading() const {
  std::string out = kColumns;
  for (std::size_t i = 1; i <= columns_->thrusters; ++i)
    out += fmt::format(",command_{}_n,thrust_{}_n", i, i);
  for (const std::size_t i : columns_->sensors) out += kSensorColumns[i].names;
  if (columns_->estimate) out += kEstimateColumns;
  if (columns_->tether) out += kTetherColumns;
  if (columns_->humans) out += kHumanColumns;
  if (columns_->silent) out += ",silent";
  return out + ",hash\n";
}

std::string DiveCsv::lines(const DiveRows& rows) const {
  std::string out;
  auto human = rows.humans.begin();
  const auto humans_until = [&](double time_s) {
    for (; human != rows.humans.end() && human->time_s < time_s; ++human) append(out, *human);
  };
  for (const DiveRow& row : rows.vehicles) {
    humans_until(row.time_s);
    append(out, row);
  }
  humans_until(std::numeric_limits<double>::infinity());
  return out;
}

}  // namespace neritic::testbed
