// Bodies and motions that the tests of the diver share; what is drawn at random is the same for the
// same index on any machine.
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "diver/flutter_kick.hpp"
#include "diver/human_step.hpp"
#include "engine/core/random.hpp"

namespace neritic::diver {

inline Body body_with(const Gear& gear, Model model = Model::kFull,
                      double water_kg_m3 = kSeaWater_kg_m3) {
  BodyParameters p;
  p.gear = gear;
  p.model = model;
  p.water_kg_m3 = water_kg_m3;
  return make_body(p).value();
}
inline Gear fins_only() {
  Gear gear = no_gear();
  gear.fins = Fins{};
  return gear;
}
// Water that moves along but takes nothing.
inline Body without_drag(Body body) {
  for (Part& part : body.parts) part.drag_first = part.drag_second = part.drag_along = 0.0;
  for (Edge& edge : body.edges) edge.added_kg_m = 0.0;
  for (BluntDrag& blunt : body.blunt) blunt.half_rho_area = 0.0;
  return body;
}

class HumanDraws {
 public:
  explicit HumanDraws(std::uint64_t index) : key_{20260102, 5, index} {}
  double uniform(double from, double to) {
    return from + (to - from) * random_uniform(key_, count_++);
  }
  Vec3 vec3(double most) {
    return {uniform(-most, most), uniform(-most, most), uniform(-most, most)};
  }
  Quat attitude() {
    const Quat q(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
    return glm::length(q) > 1e-3 ? glm::normalize(q) : Quat(1.0, 0.0, 0.0, 0.0);
  }
  JointAngles angles(double most_rad) {
    JointAngles out;
    for (Vec3& joint : out) joint = vec3(most_rad);
    return out;
  }
  LimbState limbs(double most_rad, double most_rad_s) {
    LimbState out;
    out.rotation = rotations_of(angles(most_rad));
    for (Vec3& rate : out.rate) rate = vec3(most_rad_s);
    return out;
  }

 private:
  RandomKey key_;
  std::uint64_t count_ = 0;
};

// Limbs that swing at their own pace, smoothly.
inline JointRotations swinging(std::uint64_t index, double t, double most_rad = 0.5) {
  HumanDraws draws(index);
  JointAngles angles;
  for (Vec3& joint : angles)
    for (int axis = 0; axis < 3; ++axis)
      joint[axis] = most_rad * std::sin(2.0 * kPi * draws.uniform(0.3, 1.2) * t +
                                        draws.uniform(0.0, 2.0 * kPi));
  return rotations_of(angles);
}

// Gas so that the body neither rises nor sinks there.
inline GasLoad neutral_load(const Body& body, double depth_m) {
  GasLoad load;
  double kg = dry_mass(body);
  for (std::size_t i = 0; i < body.tank_count; ++i) kg += load.tank_kg[i] = 1.4;
  load.lungs_m3 = kg / body.water_kg_m3 - solid_volume(body, depth_m);
  return load;
}

// Weight and buoyancy off: which way it swims is all one.
inline Body weightless(Body body) {
  for (SegmentBody& s : body.segments) s.mass_kg = 0.0;
  for (Part& part : body.parts) part.volume_m3 = part.suit_gas_m3 = 0.0;
  return body;
}

// A steady flutter kick far from the surface, by what neither sinks nor rises; no steering, so the
// body pitches as the kick has it. Means of the last whole beats.
struct KickRun {
  double speed_m_s = 0.0, power_w = 0.0, positive_power_w = 0.0;
};
inline KickRun kick_steadily(const Gear& gear, const FlutterKick& kick, double frequency_hz,
                             double seconds = 14.0, double dt_s = 1.0 / 240.0,
                             Model model = Model::kPlanar) {
  const Body body = weightless(body_with(gear, model));
  RootState root;
  root.position_ned_m.z = 100.0;
  root.velocity[0] = 0.6 * frequency_hz;
  JointAngles joints = streamlined(body);
  set_flutter(joints, body, kick, 0.0);
  LimbState limbs;
  limbs.rotation = rotations_of(joints);
  const double measured_s = std::round(6.0 * frequency_hz) / frequency_hz;
  KickRun run;
  double counted_s = 0.0;
  const int steps = static_cast<int>(std::lround(seconds / dt_s));
  for (int i = 0; i < steps; ++i) {
    set_flutter(joints, body, kick, 2.0 * kPi * frequency_hz * (i + 1) * dt_s);
    const LimbState before = limbs;
    follow_limbs(limbs, rotations_of(joints), dt_s);
    const LimbWork work = move_root(body, root, before, limbs, {}, Vec3(0.0), dt_s);
    if (i * dt_s < seconds - measured_s) continue;
    counted_s += dt_s;
    run.speed_m_s += root.velocity[0] * dt_s;
    run.power_w += work.power_w * dt_s;
    run.positive_power_w += std::max(0.0, work.power_w) * dt_s;
  }
  run.speed_m_s /= counted_s;
  run.power_w /= counted_s;
  run.positive_power_w /= counted_s;
  return run;
}

// 1/2 rho C_d A v^2 along the motion, as an area: at rest in itself, incidence head up in degrees.
inline double drag_area(const Body& body, const JointAngles& joints, double incidence_deg,
                        double speed_m_s = 0.514) {
  const double a = radians(incidence_deg);
  const Vec6 velocity = vec6(speed_m_s * Vec3(std::cos(a), 0.0, std::sin(a)), Vec3(0.0));
  const WaterForces f = water_forces(body, posture_of(body, rotations_of(joints), {}), velocity,
                                     {{0.0, 0.0, 1.0}, 15.0});
  return -dot(f.wrench, velocity) / (0.5 * body.water_kg_m3 * speed_m_s * speed_m_s * speed_m_s);
}

}  // namespace neritic::diver
