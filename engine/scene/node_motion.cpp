#include "engine/scene/node_motion.hpp"

#include <algorithm>
#include <cmath>

namespace neritic::scene {
namespace {

Quat turned(double revolutions) {
  const double half_rad = kPi * (revolutions - std::floor(revolutions));
  return Quat(std::cos(half_rad), 0.0, 0.0, std::sin(half_rad));
}

}  // namespace

NodePlace place_at(const NodeKeys& keys, std::size_t i, double time_s) {
  const NodeKey& a = *keys.before;
  if (!keys.after) {
    NodePlace out{a.rotations[i], a.scales[i]};
    if (!a.places_m.empty()) out.place_m = a.places_m[i];
    if (!a.turns.empty()) {
      const double ahead_s = std::clamp(time_s - a.time_s, 0.0, keys.most_ahead_s);
      out.rotation = out.rotation * turned(a.turns[i].revolutions + ahead_s * a.turns[i].per_s);
    }
    return out;
  }
  const NodeKey& b = *keys.after;
  const double share = (time_s - a.time_s) / (b.time_s - a.time_s);
  // Neighbouring keys are close, so that the chord is as good as the arc.
  const Quat to = glm::dot(a.rotations[i], b.rotations[i]) < 0.0 ? -b.rotations[i] : b.rotations[i];
  NodePlace out{glm::normalize(a.rotations[i] * (1.0 - share) + to * share),
                a.scales[i] + share * (b.scales[i] - a.scales[i])};
  if (!a.places_m.empty() && !b.places_m.empty())
    out.place_m = a.places_m[i] + share * (b.places_m[i] - a.places_m[i]);
  if (!a.turns.empty() && !b.turns.empty())
    out.rotation = out.rotation * turned(a.turns[i].revolutions +
                                         share * (b.turns[i].revolutions - a.turns[i].revolutions));
  return out;
}

}  // namespace neritic::scene
