#include "testbed/simulation/place_outlook.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/sim/contact_memory.hpp"
#include "rov/frames.hpp"
#include "rov/navigation_water.hpp"

namespace neritic::testbed {
namespace {

// No sea is deeper.
constexpr double kDeepest_m = 12e3;
// A leg is looked at in so many places, its ends among them; a long one more closely.
constexpr int kPlacesALeg = 9;
constexpr double kPlacesApart_m = 10.0;
constexpr int kMostPlacesALeg = 200;

// A sensor that errs less is set to its water: the sea's own density differs by 0.3 %.
constexpr double kPressureOff_m = 0.1, kPressureOffShare = 0.01;

// One who goes to a waypoint, and how it lies there.
struct Visitor {
  const std::string& name;
  const sim::BodyShape& shape;
  double acceptance_m;
};

// Places in the air. What floats comes no higher.
bool in_air(const Visitor& visitor, std::size_t waypoint, const Vec3& place_ned_m,
            std::vector<std::string>& lines) {
  if (place_ned_m.z >= 0.0) return false;
  lines.push_back(
      fmt::format("{}: waypoint {} lies {:.3g} m above the surface; accepted: at it or below it",
                  visitor.name, waypoint + 1, -place_ned_m.z));
  return true;
}

// The first face of the bed over a place that lies below the bed: under one face, or three. Under
// an overhang there are two.
std::optional<sim::RayHit> bed_over(const PhysicsWorld& world, const Vec3& place_ned_m) {
  constexpr int kMostFaces = 64;
  constexpr double kPast_m = 1e-3;
  std::optional<sim::RayHit> first;
  int faces = 0;
  const Vec3 from_m = rov::world_from_ned(place_ned_m);
  double up_m = 0.0;
  for (int i = 0; i < kMostFaces; ++i) {
    const auto hit = world.solid().cast(from_m + Vec3(0.0, up_m, 0.0), Vec3(0.0, 1.0, 0.0),
                                        std::max(place_ned_m.z - up_m, 1.0));
    if (!hit) break;
    if (world.is_bed(hit->label)) {
      ++faces;
      if (!first) {
        first = hit;
        first->distance_m += up_m;
      }
    }
    up_m += hit->distance_m + kPast_m;
  }
  if (faces % 2 == 0) first.reset();
  return first;
}

bool in_solid(const PhysicsWorld& world, const Visitor& visitor, std::size_t waypoint,
              const Vec3& place_ned_m, double heading_rad, std::vector<std::string>& lines) {
  const double allowed_m = visitor.acceptance_m;
  const auto add = [&](double depth_m, const char* where, std::uint32_t label) {
    lines.push_back(
        fmt::format("{}: waypoint {} lies {:.3g} m {} {}: it is not reached; move it "
                    "into the water, or give {} collision = false",
                    visitor.name, waypoint + 1, depth_m, where, world.solid_name(label),
                    world.solid_name(label)));
    return true;
  };
  if (const auto bed = bed_over(world, place_ned_m); bed && bed->distance_m > allowed_m)
    return add(bed->distance_m, "below the bed", bed->label);
  sim::ContactMemory memory;
  const Pose pose = rov::world_pose(place_ned_m, rov::heading_attitude(heading_rad));
  const sim::Contact* worst = nullptr;
  const auto contacts = world.solid().contacts(visitor.shape, pose, 0.0, memory);
  for (const sim::Contact& contact : contacts)
    if (-contact.gap_m > allowed_m && (!worst || contact.gap_m < worst->gap_m)) worst = &contact;
  if (!worst) return false;
  return add(-worst->gap_m, "in", worst->surface.label);
}

// Whether the log hears a bottom there, level, at the heading that the vehicle has.
bool hears_bottom(const PhysicsWorld& world, const PhysicsVehicle& vehicle, const Vec3& place_ned_m,
                  double heading_rad) {
  rov::State state = vehicle.start;
  state.position_ned_m = place_ned_m;
  state.attitude = rov::heading_attitude(heading_rad);
  return rov::read_dvl(*vehicle.file.sensors.dvl, vehicle.water, state, world.rays(),
                       rov::NoiseSource{}, 0)
      .locked();
}

}  // namespace

void add_places(const PhysicsWorld& world, const PhysicsVehicle& vehicle,
                std::vector<std::string>& lines) {
  const std::size_t count = vehicle.mission->waypoint_count();
  if (count == 0) return;
  const auto legs = vehicle.mission->legs(vehicle.start, world.start());
  const Visitor visitor{vehicle.name, vehicle.kind.solid.shape, vehicle.mission->acceptance_m()};
  bool air = false, solid = false;
  for (std::size_t i = 0; i < count; ++i) {
    const MissionGuide::LegPoint& place = legs[i].points.back();
    air = air || in_air(visitor, i, place.place_ned_m, lines);
    solid = solid ||
            in_solid(world, visitor, i, place.place_ned_m, place.heading_rad.value_or(0.0), lines);
  }
}

void add_places(const PhysicsWorld& world, const PhysicsHuman& human,
                std::vector<std::string>& lines) {
  const Visitor visitor{human.name, human.shape, human.acceptance_m};
  Vec3 from = human.start.human.root.position_ned_m;
  bool air = false, solid = false;
  for (std::size_t i = 0; i < human.waypoints_ned_m.size(); ++i) {
    const Vec3 &to = human.waypoints_ned_m[i], way = to - from;
    air = air || in_air(visitor, i, to, lines);
    solid = solid || in_solid(world, visitor, i, to, std::atan2(way.y, way.x), lines);
    from = to;
  }
}

void add_doppler_log(const PhysicsWorld& world, const PhysicsVehicle& vehicle,
                     std::vector<std::string>& lines) {
  if (!vehicle.file.sensors.dvl) return;
  const rov::Dvl& dvl = *vehicle.file.sensors.dvl;
  const bool empty = world.solid().counts().things == 0;
  const auto legs = vehicle.mission->legs(vehicle.start, world.start());
  if (legs.empty() && !empty) return;
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const MissionGuide::Leg& leg : legs) {
    const Vec3 way = leg.to_ned_m - leg.from_ned_m;
    const int places =
        std::clamp(static_cast<int>(std::ceil(glm::length(way) / kPlacesApart_m)) + 1, kPlacesALeg,
                   kMostPlacesALeg);
    for (int i = 0; i < places && !empty; ++i) {
      const Vec3 place = leg.from_ned_m + static_cast<double>(i) / (places - 1) * way;
      const double heading_rad = leg.points[1].heading_rad.value_or(0.0);
      if (hears_bottom(world, vehicle, place, heading_rad)) return;
      const rov::RayQuery rays = world.rays();
      nearest_m = std::min(nearest_m, rays.cast(rays.context, place, Vec3(0, 0, 1), kDeepest_m));
    }
  }
  const std::string bed = empty ? "the scene has nothing solid"
                          : std::isfinite(nearest_m)
                              ? fmt::format(
                                    "what lies under its way is {:.3g} m off at best, it "
                                    "hears from {:.3g} to {:.3g} m",
                                    nearest_m, dvl.least_m, dvl.most_m)
                              : std::string("nothing solid lies under its way");
  lines.push_back(fmt::format(
      "{}: its DVL never hears a bottom: {}{}; add a bed (class = "
      "\"seabed\"), dive nearer to it{}",
      vehicle.name, bed, vehicle.navigation ? ", so that its navigation drifts" : "",
      vehicle.navigation && !vehicle.file.sensors.usbl ? ", or add [usbl] to its file" : ""));
}

double deepest_m(const PhysicsVehicle& vehicle) {
  double out_m = vehicle.start.position_ned_m.z;
  if (vehicle.mission)
    for (const Vec3& place : vehicle.mission->waypoints_ned_m()) out_m = std::max(out_m, place.z);
  return std::max(out_m, 0.0);
}

void add_pressure(const PhysicsVehicle& vehicle, std::vector<std::string>& lines) {
  const auto& pressure = vehicle.file.sensors.pressure;
  if (!vehicle.navigation || !pressure) return;
  const double at_m = deepest_m(vehicle);
  const double zero_m = rov::told_depth_m(*pressure, vehicle.water, 0.0);
  const double off_m = rov::told_depth_m(*pressure, vehicle.water, at_m) - at_m;
  const double least_m = std::max(kPressureOff_m, kPressureOffShare * at_m);
  std::string causes;
  if (std::abs(zero_m) > 0.5 * least_m)
    causes +=
        fmt::format("pressure.surface_pa = {:.6g}, the scene's air has {:.6g}",
                    pressure->surface_pa.value_or(vehicle.water.air_pa), vehicle.water.air_pa);
  if (std::abs(off_m - zero_m) > 0.5 * least_m)
    // N/m^3 over the sensor's own gravity: the density to set, its mean down to there.
    causes += fmt::format("{}pressure.water_kg_m3 = {:.6g}, the scene's water is {:.6g}",
                          causes.empty() ? "" : "; ", pressure->water_kg_m3,
                          (vehicle.water.pressure_pa(at_m) - vehicle.water.air_pa) /
                              (pressure->gravity_m_s2 * std::max(at_m, 1e-6)));
  if (std::abs(off_m) <= least_m && std::abs(zero_m) <= least_m) return;
  lines.push_back(
      fmt::format("{}: its depth reads {:.2f} m too {} at {:.3g} m: {}; it navigates by it",
                  vehicle.name, std::abs(off_m), off_m < 0.0 ? "shallow" : "deep", at_m, causes));
}

}  // namespace neritic::testbed
