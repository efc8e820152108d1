#include "testbed/simulation/thrust_outlook.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace neritic::testbed {
namespace {

// The share of a push that may go astray: N or N m a newton.
constexpr double kAstray = 0.01;
constexpr double kNoPush = 1e-3;  // N, N m

// Row i is the wrench nearest to one unit along axis i that the thrusters give, without limits: the
// projector B B^+ onto what they reach. An axis whose own entry is 1 is controlled by itself, one
// with 0 is not pushed at all; others only together with the axes whose entries are not 0.
std::array<rov::Vec6, 6> reached_of(const rov::Allocator& allocator) {
  std::array<rov::Vec6, 6> out;
  for (std::size_t axis = 0; axis < 6; ++axis) {
    std::array<double, rov::kMaxThrusters> force_n{};
    for (std::size_t i = 0; i < allocator.count(); ++i)
      force_n[i] = allocator.inverse().rows[i][axis];
    out[axis] = allocator.wrench_of(force_n);
  }
  return out;
}
constexpr double kWhole = 1.0 - 1e-9;

constexpr const char* kAxisWords[] = {"forward or back (surge)", "to the side (sway)",
                                      "up or down (heave)",      "over to a side (roll)",
                                      "nose up or down (pitch)", "round (yaw)"};

std::string listed(std::span<const std::size_t> axes) {
  std::string out;
  for (std::size_t i = 0; i < axes.size(); ++i)
    out += (i == 0 ? "" : i + 1 == axes.size() ? " and " : ", ") + std::string(kAxisWords[axes[i]]);
  return out;
}

// Axes that thrusters push only together, `axis` among them.
std::vector<std::size_t> coupled_with(const std::array<rov::Vec6, 6>& reached, std::size_t axis) {
  std::array<bool, 6> in{};
  in[axis] = true;
  for (std::size_t round = 0; round < 6; ++round)
    for (std::size_t i = 0; i < 6; ++i)
      for (std::size_t k = 0; k < 6; ++k)
        if (in[i] && std::abs(reached[i][k]) > 1e-6) in[k] = true;
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < 6; ++i)
    if (in[i]) out.push_back(i);
  return out;
}

// Adds a line about the tilt that a push brings, where it comes with roll or pitch alone.
void add_tilting_push(const PhysicsVehicle& vehicle, std::size_t axis,
                      std::span<const std::size_t> coupled, std::vector<std::string>& lines) {
  constexpr double kTilted = 0.17364817766693033;  // the sine of 10 degrees
  const rov::Vehicle& v = vehicle.vehicle;
  const double rights_n_m =
      std::max(0.0, (v.weight_n * v.gravity_centre_m - v.buoyancy_n * v.buoyancy_centre_m).z);
  const rov::Vec6 reached = reached_of(vehicle.kind.allocator)[axis];
  const double lever_m = std::hypot(reached[3], reached[4]) / reached[axis];
  const double most_n = most_along(vehicle, axis_of(axis, 1.0));
  if (axis == 5 || most_n * lever_m <= kTilted * rights_n_m) return;
  std::vector<std::size_t> tilts;
  for (const std::size_t i : coupled)
    if (i == 3 || i == 4) tilts.push_back(i);
  const double upright_n = rights_n_m / lever_m;
  lines.push_back(fmt::format(
      "{}: its thrusters push {} only together with {}: {}", vehicle.name, kAxisWords[axis],
      listed(tilts),
      upright_n < most_n ? fmt::format("above {:.3g} of {:.3g} N it overturns", upright_n, most_n)
                         : fmt::format("{:.3g} N tilt it by {:.0f} degrees", most_n,
                                       degrees(std::asin(most_n / upright_n)))));
}

}  // namespace

Push push_along(const PhysicsVehicle& vehicle, const rov::Vec6& direction) {
  const rov::Allocator& allocator = vehicle.kind.allocator;
  const auto given = allocator.allocate(1e6 * direction, vehicle.file.gains.saturation).force_n;
  const rov::Vec6 wrench = allocator.wrench_of(given);
  const double most = std::max(0.0, dot(wrench, direction));
  if (!(most > kNoPush)) return {0.0, 1.0};
  rov::Vec6 off = wrench - most * direction;
  const auto reached = reached_of(allocator);
  for (const std::size_t axis : {3, 4})
    if (reached[axis][axis] < kWhole) off[axis] = 0.0;
  return {most, std::sqrt(dot(off, off)) / most};
}

double most_along(const PhysicsVehicle& vehicle, const rov::Vec6& direction) {
  const Push push = push_along(vehicle, direction);
  return push.astray <= kAstray ? push.most : 0.0;
}

rov::Vec6 axis_of(std::size_t axis, double sign) {
  rov::Vec6 out;
  out[axis] = sign;
  return out;
}

void add_axes(const PhysicsVehicle& vehicle, std::vector<std::string>& lines) {
  const auto reached = reached_of(vehicle.kind.allocator);
  std::array<bool, 6> told{};
  for (const std::size_t axis : {0, 1, 2, 5}) {
    if (told[axis]) continue;
    const std::vector<std::size_t> coupled = coupled_with(reached, axis);
    const auto more = std::ranges::count_if(coupled, [](auto i) { return i != 3 && i != 4; });
    if (reached[axis][axis] > 1e-6 && reached[axis][axis] < kWhole && more > 1) {
      double left = 0.0;
      for (const std::size_t i : coupled) left += reached[i][i], told[i] = true;
      lines.push_back(fmt::format(
          "{}: its thrusters push {} only together, not each by itself: {:.0f} of these {} can be "
          "chosen, and the others follow; it may not hold its way or its heading",
          vehicle.name, listed(coupled), left, coupled.size()));
    } else if (std::min(most_along(vehicle, axis_of(axis, 1.0)),
                        most_along(vehicle, axis_of(axis, -1.0))) < kNoPush) {
      lines.push_back(fmt::format("{}: its thrusters push 0 {} {}: that axis is not controlled",
                                  vehicle.name, axis == 5 ? "N m" : "N", kAxisWords[axis]));
    } else if (coupled.size() > 1 && reached[axis][axis] < kWhole) {
      add_tilting_push(vehicle, axis, coupled, lines);
    }
  }
}

void add_trim(const PhysicsVehicle& vehicle, std::vector<std::string>& lines) {
  constexpr double kTilted_rad = radians(10.0);
  const rov::Vehicle& v = vehicle.vehicle;
  // N m for each axis: ahead, to starboard, down.
  const Vec3 off = v.weight_n * v.gravity_centre_m - v.buoyancy_n * v.buoyancy_centre_m;
  const auto held = [&](std::size_t axis) {
    return std::min(most_along(vehicle, axis_of(axis, 1.0)),
                    most_along(vehicle, axis_of(axis, -1.0)));
  };
  const auto add = [&](double moment_n_m, std::size_t axis, const char* words) {
    const double tilt_rad = std::atan2(std::abs(moment_n_m), off.z), held_n_m = held(axis);
    if (std::abs(moment_n_m) <= held_n_m || tilt_rad < kTilted_rad) return;
    lines.push_back(
        fmt::format("{}: its weight pulls the {} down with {:.3g} N m, its thrusters hold {:.3g}: "
                    "left alone it tilts by {:.0f} degrees",
                    vehicle.name, words, std::abs(moment_n_m), held_n_m, degrees(tilt_rad)));
  };
  add(off.x, 4, off.x > 0.0 ? "nose" : "stern");
  add(off.y, 3, off.y > 0.0 ? "starboard side" : "port side");
}

void add_buoyancy(const PhysicsVehicle& vehicle, std::vector<std::string>& lines) {
  const double up_n = vehicle.vehicle.buoyancy_n - vehicle.vehicle.weight_n;
  const double most_n = most_along(vehicle, axis_of(2, up_n > 0.0 ? 1.0 : -1.0));
  if (std::abs(up_n) <= most_n) return;
  lines.push_back(
      fmt::format("{}: {:.4g} N too {}: its thrusters push {} with {:.3g} N at most, so "
                  "it does not hold its depth",
                  vehicle.name, std::abs(up_n), up_n > 0.0 ? "buoyant" : "heavy",
                  up_n > 0.0 ? "down" : "up", most_n));
}

}  // namespace neritic::testbed
