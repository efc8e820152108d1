#include "rov/acoustic_sensors.hpp"

#include <cmath>
#include <limits>

namespace neritic::rov {
namespace {

// Of sound in a scene that does not name its water: what most instruments are set to.
constexpr double kUnnamedSound_m_s = 1500.0;
constexpr double kNothing = std::numeric_limits<double>::infinity();

double cast(const RayQuery& rays, const Vec3& origin, const Vec3& direction, double least,
            double most) {
  if (!rays.cast) return kNothing;
  const double distance = rays.cast(rays.context, origin, direction, most);
  return distance >= least && distance <= most ? distance : kNothing;
}

// What an instrument that is set to a speed of sound makes of the travel time along a ray.
double converted_m(const std::optional<double>& taken_m_s, const SensorWater& water,
                   const Vec3& origin, const Vec3& direction, double distance) {
  if (!taken_m_s) return distance;
  return distance * *taken_m_s *
         water.slowness_s_m(origin.z, origin.z + distance * direction.z, *taken_m_s);
}

Vec3 position_of(const State& state, const Vec3& mounted_at) {
  return state.position_ned_m + state.attitude * mounted_at;
}

// The v with the least sum of (b_i . v - s_i)^2 over the beams heard, from the normal equations.
Vec3 least_squares(const Dvl& dvl, const DvlReading& reading) {
  Mat3 normal(0.0);
  Vec3 right(0.0);
  for (std::size_t i = 0; i < 4; ++i) {
    if (!reading.hears(i)) continue;
    const Vec3 beam = dvl_beam(dvl, i);
    normal += glm::outerProduct(beam, beam);
    right += reading.speed_m_s[i] * beam;
  }
  return glm::inverse(normal) * right;
}

}  // namespace

Vec3 dvl_beam(const Dvl& dvl, std::size_t i) {
  const double azimuth = dvl.first_beam_rad + 0.5 * kPi * static_cast<double>(i);
  return {std::sin(dvl.lean_rad) * std::cos(azimuth), std::sin(dvl.lean_rad) * std::sin(azimuth),
          std::cos(dvl.lean_rad)};
}

DvlReading read_dvl(const Dvl& dvl, const SensorWater& water, const State& state,
                    const RayQuery& rays, const NoiseSource& noise, std::uint64_t sample) {
  const Vec3 origin = position_of(state, dvl.mount.position_m);
  const Quat ned_from_sensor = state.attitude * dvl.mount.rotation;
  const Vec3 velocity =
      glm::conjugate(dvl.mount.rotation) *
      (state.velocity.linear() + glm::cross(state.velocity.angular(), dvl.mount.position_m));
  // The shift is of the sound at the transducer: how it bends further down changes nothing.
  const double slowness_s_m =
      water.slowness_s_m(origin.z, origin.z, dvl.sound_m_s.value_or(kUnnamedSound_m_s));
  DvlReading out;
  out.sound_m_s = dvl.sound_m_s.value_or(1.0 / slowness_s_m);
  const double speed_scale = dvl.sound_m_s ? *dvl.sound_m_s * slowness_s_m : 1.0;
  double reach = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 beam = dvl_beam(dvl, i), direction = ned_from_sensor * beam;
    const double distance = cast(rays, origin, direction, dvl.least_m, dvl.most_m);
    if (!std::isfinite(distance)) continue;
    out.heard |= std::uint64_t{1} << i;
    const double speed = speed_scale * glm::dot(beam, velocity);
    Noise speed_noise = dvl.noise;
    speed_noise.white = std::hypot(speed_noise.white, dvl.noise_share * speed);
    out.speed_m_s[i] = speed + noise.error(speed_noise, i, sample, dvl.rate_hz);
    out.range_m[i] = converted_m(dvl.sound_m_s, water, origin, direction, distance) +
                     noise.error(dvl.range_noise, 4 + i, sample, dvl.rate_hz);
    reach += out.range_m[i] * direction.z;
  }
  if (out.heard != 0) out.altitude_m = reach / std::popcount(out.heard);
  if (out.locked()) out.velocity_m_s = least_squares(dvl, out);
  return out;
}

AltimeterReading read_altimeter(const Altimeter& altimeter, const SensorWater& water,
                                const State& state, const RayQuery& rays, const NoiseSource& noise,
                                std::uint64_t sample) {
  const Vec3 down = state.attitude * (altimeter.mount.rotation * Vec3(0.0, 0.0, 1.0));
  const Vec3 origin = position_of(state, altimeter.mount.position_m);
  const double there = cast(rays, origin, down, altimeter.least_m, altimeter.most_m);
  if (!std::isfinite(there)) return {};
  const double distance = converted_m(altimeter.sound_m_s, water, origin, down, there);
  Noise of_distance = altimeter.noise;
  of_distance.white = std::hypot(of_distance.white, altimeter.noise_share * distance);
  return {distance + noise.error(of_distance, 0, sample, altimeter.rate_hz), 1};
}

UsblReading read_usbl(const Usbl& usbl, const SensorWater& water, const State& state,
                      const NoiseSource& noise, std::uint64_t sample) {
  const Vec3 beacon = position_of(state, usbl.beacon_m);
  const Vec3 line = beacon - usbl.transceiver_ned_m;
  const double distance = glm::length(line);
  UsblReading out;
  if (distance > usbl.most_m || noise.uniform(0, sample) < usbl.lost_share) return out;
  out.heard = 1;
  const double level = std::hypot(line.x, line.y);
  out.travel_s =
      2.0 * distance * water.slowness_s_m(usbl.transceiver_ned_m.z, beacon.z, usbl.sound_m_s);
  out.range_m =
      0.5 * usbl.sound_m_s * out.travel_s + noise.error(usbl.range_noise, 1, sample, usbl.rate_hz);
  // Both errors are angles of the line of sight: a bearing turns less where it points down.
  const double across = noise.error(usbl.direction_noise, 2, sample, usbl.rate_hz);
  const double bearing = level > 0.0 ? std::atan2(line.y, line.x) : 0.0;
  out.bearing_rad = bearing + across * distance / std::max(level, 1e-3 * distance + 1e-12);
  out.elevation_rad =
      std::atan2(line.z, level) + noise.error(usbl.direction_noise, 3, sample, usbl.rate_hz);
  const double flat = out.range_m * std::cos(out.elevation_rad);
  out.position_ned_m = usbl.transceiver_ned_m + Vec3(flat * std::cos(out.bearing_rad),
                                                     flat * std::sin(out.bearing_rad),
                                                     out.range_m * std::sin(out.elevation_rad));
  return out;
}

}  // namespace neritic::rov
