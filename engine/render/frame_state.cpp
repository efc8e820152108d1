#include "engine/render/frame_state.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <set>
#include <tuple>

#include "engine/render/views.hpp"
#include "engine/scene/flock_motion.hpp"
#include "engine/scene/model_lights.hpp"

namespace neritic::render {
namespace {

// Marks the joints of a skin that hang on the node "head"; none where the model has no such node.
std::vector<bool> joints_of_head(const scene::Model& model, int skin) {
  const auto& joints = model.skins[static_cast<std::size_t>(skin)].joints;
  std::vector<bool> out(joints.size(), false);
  for (std::size_t i = 0; i < joints.size(); ++i)
    for (int node = joints[i]; node >= 0 && !out[i];
         node = model.nodes[static_cast<std::size_t>(node)].parent)
      out[i] = model.nodes[static_cast<std::size_t>(node)].name == "head";
  return out;
}

// headless: joints that shrink into the place of the node "head", which is the neck, with all their
// skin. Not to nothing: normals keep their directions.
void append_joints(std::vector<Mat4f>& out, const scene::Model& model, const scene::ModelPose& pose,
                   int skin, const std::vector<bool>& headless = {}) {
  const auto matrices = scene::joint_matrices(model, pose, skin);
  constexpr double kShrunk = 1e-4;
  Mat4 shrink(1.0);
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    if (model.nodes[i].name != "head") continue;
    const Vec3 neck(pose.model_from_node[i][3]);
    shrink = glm::scale(glm::translate(Mat4(1.0), neck), Vec3(kShrunk));
    shrink = glm::translate(shrink, -neck);
  }
  for (std::size_t i = 0; i < matrices.size(); ++i)
    out.push_back(Mat4f(i < headless.size() && headless[i] ? shrink * matrices[i] : matrices[i]));
}

// KHR_lights_punctual: a light shines along its node's -z; scale changes neither light nor
// direction.
PlacedLight placed_light(const scene::Scene& scene, const FrameState& state,
                         const scene::ModelLight& from) {
  Appearance shown;
  shown.object = static_cast<std::uint32_t>(from.object);
  shown.node = static_cast<std::uint32_t>(from.node);
  shown.copy = from.copy;
  const Mat4 m = world_from_appearance(scene, state.world_from_object[from.object],
                                       state.poses[from.object], shown, false);
  PlacedLight placed{&scene::light_of(scene, from), Vec3(m[3])};
  const double length = glm::length(Vec3(m[2]));
  if (length > 0.0 && std::isfinite(length)) placed.direction = -Vec3(m[2]) / length;
  return placed;
}

void append_weights(std::vector<float>& out, const scene::ModelPose& pose, std::uint32_t node,
                    std::uint32_t count) {
  const std::vector<float>& weights = pose.morph_weights[node];
  for (std::uint32_t i = 0; i < count; ++i) out.push_back(i < weights.size() ? weights[i] : 0.0f);
}

// A ball and a box round what these joints' matrices bring their parts to. Weights sum to 1 but for
// rounding.
void bound_job(DeformJob& job, const GpuPrimitive& primitive, const std::vector<Mat4f>& joints,
               std::size_t first) {
  scene::Bounds box;
  for (const JointBound& part : primitive.joint_bounds) {
    if (first + part.joint >= joints.size()) return;
    const Mat4 m(joints[first + part.joint]);
    const Vec3 center_m(m * Vec4(part.center_m, 1.0));
    Vec3 reach_m(0.0);
    for (int axis = 0; axis < 3; ++axis) reach_m += glm::abs(Vec3(m[axis])) * part.half_m[axis];
    box.add(center_m - reach_m);
    box.add(center_m + reach_m);
  }
  if (box.empty() || !is_finite(box.min) || !is_finite(box.max)) return;
  job.center_m = 0.5 * (box.min + box.max);
  job.half_m = 0.5 * (box.max - box.min) * 1.01 + 1e-4;
  job.radius_m = 0.5 * glm::length(box.max - box.min) * 1.01 + 1e-4;
}

}  // namespace

const DeformJob* FrameState::job_of(std::uint32_t group, std::uint32_t object, std::uint32_t node,
                                    bool headless) const {
  const auto key_of = [](const DeformJob& job) {
    return std::make_tuple(job.group, job.object, job.node, job.headless);
  };
  const auto key = std::make_tuple(group, object, node, headless);
  const auto at =
      std::lower_bound(deforms.begin(), deforms.end(), key,
                       [&](const DeformJob& job, const auto& k) { return key_of(job) < k; });
  if (at == deforms.end() || key_of(*at) != key)
    return headless ? job_of(group, object, node) : nullptr;
  return &*at;
}

FrameState evaluate_frame(const scene::MotionSource& source, const GpuScene& gpu_scene,
                          double time_s, double next_time_s, bool motion,
                          std::span<const std::uint32_t> worn) {
  const scene::Scene& scene = source.scene();
  FrameState state;
  state.time_s = time_s;
  state.next_time_s = next_time_s;
  state.motion = motion;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    state.world_from_object.push_back(source.world_from_object(i, time_s));
    state.next_world_from_object.push_back(motion ? source.world_from_object(i, next_time_s)
                                                  : state.world_from_object.back());
    const scene::Model empty;
    const int index = scene.objects[i].model;
    const scene::Model& model = index >= 0 ? *scene.models[static_cast<std::size_t>(index)] : empty;
    state.poses.push_back(source.model_pose(i, model, time_s));
    if (motion) state.next_poses.push_back(source.model_pose(i, model, next_time_s));
    const bool flock = scene.objects[i].flock.has_value();
    state.flock.push_back(flock ? scene::flock_copies(source, i, time_s) : std::vector<Mat4>());
    state.next_flock.push_back(flock && motion ? scene::flock_copies(source, i, next_time_s)
                                               : std::vector<Mat4>());
  }
  for (const scene::Lamp& lamp : scene.lamps)
    state.world_from_lamp.push_back(source.world_from(lamp.mount, time_s));

  for (const scene::ModelLight& light : scene.model_lights)
    state.lights.push_back(placed_light(scene, state, light));

  // One job an object's node and primitive, however many copies; groups ascend, so the list is
  // sorted.
  for (std::uint32_t g = 0; g < gpu_scene.groups().size(); ++g) {
    const DrawGroup& group = gpu_scene.groups()[g];
    const GpuPrimitive& primitive = group.primitive;
    if (!primitive.deforms()) continue;
    std::set<std::pair<std::uint32_t, std::uint32_t>> who;
    for (const Appearance& a : group.appearances) who.insert({a.object, a.node});
    for (const auto& [object, node] : who) {
      const scene::Model& model =
          *scene.models[static_cast<std::size_t>(scene.objects[object].model)];
      const int skin = model.nodes[node].skin;
      const bool skinned = primitive.first_skin != kNone && skin >= 0;
      if (!skinned && primitive.morph_targets == 0) continue;
      DeformJob job{g, object, node, false, {}};
      job.push.vertex_count = primitive.vertex_count;
      job.push.first_source = primitive.first_vertex;
      job.push.first_skin = skinned ? primitive.first_skin : kNone;
      job.push.first_morph = primitive.first_morph;
      job.push.morph_targets = primitive.morph_targets;
      job.push.first_joint = static_cast<std::uint32_t>(state.joints.size());
      job.push.first_weight = static_cast<std::uint32_t>(state.weights.size());
      job.push.first_out = state.deformed_vertices;
      job.push.next = motion ? 1u : 0u;
      if (skinned) append_joints(state.joints, model, state.poses[object], skin);
      job.push.joint_stride =
          static_cast<std::uint32_t>(state.joints.size()) - job.push.first_joint;
      if (skinned && motion) append_joints(state.joints, model, state.next_poses[object], skin);
      if (skinned) bound_job(job, primitive, state.joints, job.push.first_joint);
      append_weights(state.weights, state.poses[object], node, primitive.morph_targets);
      job.push.weight_stride = primitive.morph_targets;
      if (motion)
        append_weights(state.weights, state.next_poses[object], node, primitive.morph_targets);
      state.deformed_vertices += primitive.vertex_count;
      state.deforms.push_back(job);
      if (!skinned || std::ranges::find(worn, object) == worn.end()) continue;
      const std::vector<bool> head = joints_of_head(model, skin);
      if (std::ranges::find(head, true) == head.end()) continue;
      job.headless = true;
      job.push.first_joint = static_cast<std::uint32_t>(state.joints.size());
      job.push.first_out = state.deformed_vertices;
      append_joints(state.joints, model, state.poses[object], skin, head);
      bound_job(job, primitive, state.joints, job.push.first_joint);
      if (motion) append_joints(state.joints, model, state.next_poses[object], skin, head);
      state.deformed_vertices += primitive.vertex_count;
      state.deforms.push_back(job);
    }
  }
  return state;
}

Mat4 world_from_appearance(const scene::Scene& scene, const Pose& world_from_object,
                           const scene::ModelPose& pose, const Appearance& a, bool skinned,
                           const std::vector<Mat4>& flock) {
  const scene::Object& object = scene.objects[a.object];
  Mat4 m = to_matrix(world_from_object);
  if (a.copy >= 0)
    m = m * (flock.empty() ? object.copies : flock)[static_cast<std::size_t>(a.copy)];
  m = glm::scale(m, object.scale);
  if (!skinned) {
    m = m * pose.model_from_node[a.node];
    if (a.node_instance >= 0) {
      const scene::Model& model = *scene.models[static_cast<std::size_t>(object.model)];
      m = m * model.nodes[a.node].instances[static_cast<std::size_t>(a.node_instance)];
    }
  }
  return m;
}

}  // namespace neritic::render
