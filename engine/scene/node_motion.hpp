// Nodes of a model that are moved by something other than a clip: the joints of a diver who swims
// by physics. Plain values; any thread.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "engine/core/math.hpp"

namespace neritic::scene {

// How far a node has turned about its own z, in revolutions, which may be many between two keys: a
// propeller.
struct NodeTurn {
  double revolutions = 0.0, per_s = 0.0;
};

// Where some nodes of a model are at an instant.
struct NodeKey {
  double time_s = 0.0;
  std::vector<Quat> rotations;       // parent_from_node, one a node
  std::vector<Vec3> scales;          // one a node
  std::vector<Vec3> places_m = {};   // one a node, in its parent; empty: the model's own
  std::vector<NodeTurn> turns = {};  // one a node, after its rotation; empty: none
};

// The keys before and after an instant; borrows all.
struct NodeKeys {
  std::span<const int> nodes;  // of the model, in the order of a key's
  const NodeKey* before;
  const NodeKey* after = nullptr;  // later than before; nullptr: before holds
  double most_ahead_s = 0.0;       // without after, turns go on at their speed for so long
};

// Parent_from_node.
struct NodePlace {
  Quat rotation;
  Vec3 scale;
  std::optional<Vec3> place_m = std::nullopt;  // nothing: the model's own
};
// The place of keys.nodes[i]. Between two keys rotations turn the shortest way; scales, places and
// turns change linearly.
NodePlace place_at(const NodeKeys& keys, std::size_t i, double time_s);

}  // namespace neritic::scene
