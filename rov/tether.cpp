#include "rov/tether.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/refusal.hpp"
#include "rov/bounds.hpp"

namespace neritic::rov {
namespace {

// Gauss's three points and weights on [0, 1]: exact for the quadratic drag of a linear velocity
// that does not change its sign.
constexpr double kPoints[] = {0.1127016653792583, 0.5, 0.8872983346207417};
constexpr double kWeights[] = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};

}  // namespace

Status check_tether(const Tether& t) {
  const Bound bounds[] = {{"length_m", t.length_m, 0.1, 1e5},
                          {"diameter_m", t.diameter_m, 1e-4, 1.0},
                          {"net_weight_n_m", t.net_weight_n_m, -100.0, 100.0},
                          {"stiffness_n", t.stiffness_n, 1.0, 1e7},
                          {"damping_n_s", t.damping_n_s, 0.0, 1e6},
                          {"normal_drag", t.normal_drag, 0.0, 10.0},
                          {"tangential_drag", t.tangential_drag, 0.0, 10.0},
                          {"water_kg_m3", t.water_kg_m3, 0.0, 2000.0}};
  NERITIC_TRY_STATUS(check_bounds("tether", bounds));
  if (!is_finite(t.attachment_m) || glm::length(t.attachment_m) > 100.0)
    return refusal("tether.attachment_m", "another point", "one within 100 m of the body's origin");
  return {};
}

Vec3 tether_force_n(const Tether& t, const Vec3& anchor, const Vec3& attachment,
                    const Vec3& velocity, const Vec3& current) {
  const Vec3 span = attachment - anchor;
  const double distance = glm::length(span);
  const Vec3 along = distance > 0.0 ? span / distance : Vec3(0.0, 0.0, 1.0);
  Vec3 force(0.0, 0.0, 0.5 * t.net_weight_n_m * t.length_m);
  const double area = 0.5 * t.water_kg_m3 * t.diameter_m * t.length_m;
  for (int i = 0; i < 3; ++i) {
    const Vec3 flow = kPoints[i] * velocity - current;
    const Vec3 tangential = glm::dot(flow, along) * along, normal = flow - tangential;
    const double share = kWeights[i] * kPoints[i] * area;
    force -= share * t.normal_drag * glm::length(normal) * normal;
    force -= share * kPi * t.tangential_drag * glm::length(tangential) * tangential;
  }
  if (distance > t.length_m) {
    const double strain = (distance - t.length_m) / t.length_m;
    const double strain_rate = glm::dot(velocity, along) / t.length_m;
    force -= std::max(0.0, t.stiffness_n * strain + t.damping_n_s * strain_rate) * along;
  }
  return force;
}

}  // namespace neritic::rov
