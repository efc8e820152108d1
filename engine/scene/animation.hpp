// Poses of a model: node transforms and morph weights at an instant of a clip, joint matrices of a
// skin. Pure functions of their arguments; any thread. All matrices are in the model's frame.
#pragma once

#include <string>
#include <vector>

#include "engine/core/result.hpp"
#include "engine/scene/model.hpp"

namespace neritic::scene {

struct ModelPose {
  std::vector<Mat4> model_from_node;              // one a node
  std::vector<std::vector<float>> morph_weights;  // one a node; empty where its mesh has no targets
};

struct NodeKeys;

// The pose at time_s of clip (an index, or -1 for the rest pose). Time wraps at the clip's duration
// where loop, else it is clamped. A NaN time counts as 0.
ModelPose evaluate_pose(const Model& model, int clip, double time_s, bool loop = true);
// The pose at time_s of nodes that something else moves, the others at rest.
ModelPose evaluate_pose(const Model& model, const NodeKeys& keys, double time_s);
// Model_from_node of one node in those poses, bit for bit, for the price of the nodes above it.
Mat4 evaluate_node(const Model& model, int node, int clip, double time_s);
Mat4 evaluate_node(const Model& model, int node, const NodeKeys& keys, double time_s);

// The clip of that name (the first, where names repeat), else the one of that number from 0 on. The
// error begins with place and lists the clips that there are.
Result<int> find_clip(const Model& model, const std::string& wanted, const std::string& place);

// model_from_bind, one a joint: model_from_joint * inverse_bind.
std::vector<Mat4> joint_matrices(const Model& model, const ModelPose& pose, int skin);

// Bounds in the model's frame of all that the default scene draws in that pose.
Bounds model_bounds(const Model& model, const ModelPose& pose);

}  // namespace neritic::scene
