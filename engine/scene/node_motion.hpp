// Nodes of a model that are moved by something other than a clip: the joints of a diver who swims
// by physics. A plain value; any thread.
#pragma once

#include <vector>

#include "engine/core/math.hpp"

namespace neritic::scene {

struct NodeMotion {
  struct Key {
    double time_s = 0.0;
    std::vector<Quat> rotations;      // parent_from_node, one a node
    std::vector<Vec3> scales;         // one a node
    std::vector<Vec3> places_m = {};  // one a node, in its parent; empty: the model's own
  };
  std::vector<int> nodes;  // of the model
  std::vector<Key>
      keys;  // at least one, times rising; before the first and after the last it holds
};

// Between two keys rotations turn the shortest way, scales and places change linearly.
NodeMotion::Key key_at(const NodeMotion& motion, double time_s);

}  // namespace neritic::scene
