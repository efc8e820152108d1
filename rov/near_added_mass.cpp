#include "rov/near_added_mass.hpp"

#include <algorithm>
#include <cmath>

namespace neritic::rov {
namespace {

// The added mass of translation, as matrices of columns.
Mat3 added_translation(const Vehicle& vehicle) {
  Mat3 out(0.0);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k)
      out[static_cast<int>(k)][static_cast<int>(i)] = vehicle.mass(i, k) - vehicle.rigid_mass(i, k);
  return out;
}

void add_translation(const Mat3& more, Mat6& mass) {
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k)
      mass(i, k) += more[static_cast<int>(k)][static_cast<int>(i)];
}

}  // namespace

double displaced_radius_m(const Vehicle& vehicle, double water_kg_m3) {
  return std::cbrt(0.75 / kPi * vehicle.displaced_kg / water_kg_m3);
}

AddedShare added_share(double radius_m, const WaterBound& bound) {
  const double away_m = std::max(bound.away_m, radius_m);
  if (!(away_m <= kNearBounds * radius_m)) return {};
  const double ratio = radius_m / away_m, cube = ratio * ratio * ratio;
  const double sign = bound.free_surface ? -1.0 : 1.0;
  AddedShare out{sign * 3.0 / 16.0 * cube, sign * 3.0 / 8.0 * cube};
  if (bound.away_m > radius_m) {
    out.along_1_m = -3.0 * out.along / away_m;
    out.across_1_m = -3.0 * out.across / away_m;
  }
  return out;
}

Vec6 near_added_mass(const Vehicle& open, double radius_m, std::span<const WaterBound> bounds,
                     const Quat& attitude, const Vec6& through_water, Vehicle& near) {
  near.mass = open.mass;
  const Mat3 added = added_translation(open);
  const Vec3 v = through_water.linear(), turn = through_water.angular();
  Vec6 wrench;
  bool changed = false;
  for (const WaterBound& bound : bounds) {
    const AddedShare share = added_share(radius_m, bound);
    if (share.along == 0.0) continue;
    changed = true;
    const Vec3 n = glm::conjugate(attitude) * bound.normal_ned;
    const double more = share.across - share.along, more_1_m = share.across_1_m - share.along_1_m;
    const Vec3 added_n = added * n, added_v = added * v;
    const double across_kg = glm::dot(n, added_n), off_m_s = glm::dot(n, v);
    // A(h, n) - A of open water.
    add_translation(share.along * added + more * across_kg * glm::outerProduct(n, n), near.mass);
    // Its rate times v: h' = n v, n' = -turn x n.
    const Vec3 n_rate = -glm::cross(turn, n);
    const Vec3 changing =
        off_m_s * (share.along_1_m * added_v + more_1_m * across_kg * off_m_s * n) +
        more * (2.0 * glm::dot(n_rate, added_n) * off_m_s * n +
                across_kg * (glm::dot(n_rate, v) * n + off_m_s * n_rate));
    // The derivatives of T = 1/2 [along v A v + more (n A n) (n v)^2] by h and by n.
    const double by_away =
        0.5 * (share.along_1_m * glm::dot(v, added_v) + more_1_m * across_kg * off_m_s * off_m_s);
    const Vec3 by_normal = more * off_m_s * (off_m_s * added_n + across_kg * v);
    wrench = wrench + vec6(by_away * n - changing, -glm::cross(n, by_normal));
  }
  near.inverse_mass = changed ? inverse(near.mass) : open.inverse_mass;
  return wrench;
}

}  // namespace neritic::rov
