#include "engine/scene/node_motion.hpp"

#include <algorithm>

namespace neritic::scene {

NodeMotion::Key key_at(const NodeMotion& motion, double time_s) {
  const auto after =
      std::upper_bound(motion.keys.begin(), motion.keys.end(), time_s,
                       [](double t, const NodeMotion::Key& k) { return t < k.time_s; });
  if (after == motion.keys.begin()) return motion.keys.front();
  const NodeMotion::Key& a = *(after - 1);
  if (after == motion.keys.end()) return a;
  const NodeMotion::Key& b = *after;
  const double share = (time_s - a.time_s) / (b.time_s - a.time_s);
  NodeMotion::Key out{time_s, {}, {}, {}};
  for (std::size_t i = 0; i < motion.nodes.size(); ++i) {
    // Neighbouring keys are close, so that the chord is as good as the arc.
    const Quat to =
        glm::dot(a.rotations[i], b.rotations[i]) < 0.0 ? -b.rotations[i] : b.rotations[i];
    out.rotations.push_back(glm::normalize(a.rotations[i] * (1.0 - share) + to * share));
    out.scales.push_back(a.scales[i] + share * (b.scales[i] - a.scales[i]));
    if (!a.places_m.empty() && !b.places_m.empty())
      out.places_m.push_back(a.places_m[i] + share * (b.places_m[i] - a.places_m[i]));
  }
  return out;
}

}  // namespace neritic::scene
