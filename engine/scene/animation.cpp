// See animation.hpp. Interpolation: Khronos glTF 2.0 appendix C.
#include "engine/scene/animation.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"
#include "engine/scene/node_motion.hpp"

namespace neritic::scene {
namespace {

// Where an instant falls among a channel's keys: between key and key + 1 at fraction, or on key.
struct Place {
  std::size_t key = 0;
  double fraction = 0.0;    // 0 to 1; 0 on a key and beyond the ends
  double interval_s = 0.0;  // between the two keys
};

Place find_place(const std::vector<float>& times_s, double time_s) {
  const auto after = std::upper_bound(times_s.begin(), times_s.end(), time_s);
  if (after == times_s.begin()) return {};
  Place place;
  place.key = static_cast<std::size_t>(after - times_s.begin()) - 1;
  if (after == times_s.end()) return place;
  place.interval_s = double{*after} - times_s[place.key];
  place.fraction = (time_s - times_s[place.key]) / place.interval_s;
  return place;
}

Quat to_quat(const double* v) {
  return Quat(v[3], v[0], v[1], v[2]);
}

// Spherical linear interpolation on the shorter arc (appendix C.4); nearly equal ends are blended
// linearly, where the sine of their angle would lose its digits.
Quat slerp(const Quat& a, Quat b, double t) {
  double cosine = glm::dot(a, b);
  if (cosine < 0.0) {
    b = -b;
    cosine = -cosine;
  }
  if (cosine > 1.0 - 1e-9) return unit_or_identity(a * (1.0 - t) + b * t);
  const double angle = std::acos(std::min(cosine, 1.0));
  return unit_or_identity((a * std::sin((1.0 - t) * angle) + b * std::sin(t * angle)) /
                          std::sin(angle));
}

// The channel's value, width numbers, at an instant. Rotations come out as unit quaternions.
void sample(const Channel& channel, double time_s, std::vector<double>& out) {
  const Place place = find_place(channel.times_s, time_s);
  const std::size_t width = static_cast<std::size_t>(channel.width);
  const bool cubic = channel.interpolation == Channel::Interpolation::kCubic;
  // A cubic key holds in-tangent, value, out-tangent; the others the value alone.
  const auto value = [&](std::size_t key, int part, std::size_t c) -> double {
    return channel.values[cubic ? (key * 3 + part) * width + c : key * width + c];
  };
  out.assign(width, 0.0);
  for (std::size_t c = 0; c < width; ++c) out[c] = value(place.key, 1, c);
  const double t = place.fraction;
  if (t > 0.0 && cubic) {  // appendix C.5, Hermite
    const double t2 = t * t, t3 = t2 * t, dt = place.interval_s;
    for (std::size_t c = 0; c < width; ++c)
      out[c] = (2 * t3 - 3 * t2 + 1) * value(place.key, 1, c) +
               dt * (t3 - 2 * t2 + t) * value(place.key, 2, c) +
               (-2 * t3 + 3 * t2) * value(place.key + 1, 1, c) +
               dt * (t3 - t2) * value(place.key + 1, 0, c);
  } else if (t > 0.0 && channel.interpolation == Channel::Interpolation::kLinear) {
    std::vector<double> next(width);
    for (std::size_t c = 0; c < width; ++c) next[c] = value(place.key + 1, 1, c);
    if (channel.path == Channel::Path::kRotation) {
      const Quat q = slerp(to_quat(out.data()), to_quat(next.data()), t);
      out = {q.x, q.y, q.z, q.w};
    } else {
      for (std::size_t c = 0; c < width; ++c) out[c] += (next[c] - out[c]) * t;
    }
  }
}

// The clip's own time: wrapped or clamped to [0, duration].
double clip_time(double time_s, double duration_s, bool loop) {
  if (!std::isfinite(time_s) || duration_s <= 0.0) return 0.0;
  if (!loop) return std::clamp(time_s, 0.0, duration_s);
  const double wrapped = std::fmod(time_s, duration_s);
  return wrapped < 0.0 ? wrapped + duration_s : wrapped;
}

struct LocalPose {
  Vec3 translation_m, scale;
  Quat rotation;
};

// A value of a channel that is no weight.
void apply(Channel::Path path, const std::vector<double>& v, LocalPose& local) {
  switch (path) {
    case Channel::Path::kTranslation:
      local.translation_m = Vec3(v[0], v[1], v[2]);
      break;
    case Channel::Path::kScale:
      local.scale = Vec3(v[0], v[1], v[2]);
      break;
    case Channel::Path::kRotation:
      local.rotation = unit_or_identity(to_quat(v.data()));
      break;
    case Channel::Path::kWeights:
      break;
  }
}

void apply_clip(const Clip& clip, double time_s, std::vector<LocalPose>& locals,
                std::vector<std::vector<float>>& weights) {
  std::vector<double> v;
  for (const Channel& channel : clip.channels) {
    if (channel.times_s.empty()) continue;
    sample(channel, time_s, v);
    if (channel.path == Channel::Path::kWeights)
      weights[channel.node].assign(v.begin(), v.end());
    else
      apply(channel.path, v, locals[channel.node]);
  }
}

void apply(const NodePlace& place, LocalPose& local) {
  local.rotation = place.rotation;
  local.scale = place.scale;
  if (place.place_m) local.translation_m = *place.place_m;
}

Mat4 matrix_of(const LocalPose& local) {
  Mat4 m = glm::mat4_cast(local.rotation);
  for (int k = 0; k < 3; ++k) m[k] *= local.scale[k];
  m[3] = Vec4(local.translation_m, 1.0);
  return m;
}

// A primitive's vertex with morphs applied, in the mesh's frame.
Vec3 morphed(const Primitive& primitive, std::size_t v, const std::vector<float>& weights) {
  Vec3 p(primitive.positions[v]);
  for (std::size_t t = 0; t < primitive.targets.size() && t < weights.size(); ++t)
    if (weights[t] != 0.0f && !primitive.targets[t].positions.empty())
      p += double{weights[t]} * Vec3(primitive.targets[t].positions[v]);
  return p;
}

void add_point(Bounds& bounds, const Mat4& m, const Vec3& p) {
  const Vec3 q(m * Vec4(p, 1.0));
  if (is_finite(q)) bounds.add(q);
}

void add_corners(Bounds& bounds, const Mat4& m, const Bounds& box) {
  if (box.empty()) return;
  for (int i = 0; i < 8; ++i)
    add_point(bounds, m,
              Vec3(i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y,
                   i & 4 ? box.max.z : box.min.z));
}

// Meshes with more vertices are bounded by the corners of boxes: still safe, but less tight.
constexpr std::size_t kMaxBoundsVertices = 4'000'000;

// n_vertices: of the primitives without instances so far.
void add_node(const Model& model, const ModelPose& pose, int index, std::size_t& n_vertices,
              Bounds& bounds) {
  const Node& node = model.nodes[index];
  if (node.mesh < 0) return;
  const bool skinned = node.skin >= 0;
  const std::vector<Mat4> joints =
      skinned ? joint_matrices(model, pose, node.skin) : std::vector<Mat4>{};
  const Mat4& model_from_node = pose.model_from_node[index];
  for (const Primitive& primitive : model.meshes[node.mesh].primitives) {
    // Thousands of copies: the corners of the box will do, they contain it.
    for (const Mat4& node_from_instance : node.instances)
      add_corners(bounds, model_from_node * node_from_instance, primitive.bounds);
    if (!node.instances.empty()) continue;
    n_vertices += primitive.positions.size();
    if (n_vertices > kMaxBoundsVertices) {
      if (!skinned) add_corners(bounds, model_from_node, primitive.bounds);
      for (const Mat4& model_from_bind : joints)
        add_corners(bounds, model_from_bind, primitive.bounds);
      continue;
    }
    for (std::size_t v = 0; v < primitive.positions.size(); ++v) {
      const Vec3 p = morphed(primitive, v, pose.morph_weights[index]);
      if (!skinned || primitive.joints.empty()) {
        add_point(bounds, model_from_node, p);
        continue;
      }
      Mat4 blended(0.0);
      for (int k = 0; k < 4; ++k)
        if (primitive.weights[v][k] > 0.0f)
          blended += double{primitive.weights[v][k]} * joints[primitive.joints[v][k]];
      add_point(bounds, blended, p);
    }
  }
}

LocalPose rest_pose(const Node& node) {
  return {node.translation_m, node.scale, node.rotation};
}

Mat4 parent_from_node(const Node& node, const LocalPose& local) {
  return node.matrix ? *node.matrix : matrix_of(local);
}

// All nodes as the file has them.
std::vector<LocalPose> rest_pose(const Model& model, std::vector<std::vector<float>>& weights) {
  const std::size_t n = model.nodes.size();
  weights.resize(n);
  std::vector<LocalPose> locals(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Node& node = model.nodes[i];
    locals[i] = rest_pose(node);
    if (node.mesh >= 0)
      weights[i] = node.weights.empty() ? model.meshes[node.mesh].weights : node.weights;
  }
  return locals;
}

std::vector<Mat4> matrices_of(const Model& model, const std::vector<LocalPose>& locals) {
  const std::size_t n = model.nodes.size();
  // Parents before children, without recursion: hierarchies may be thousands deep.
  std::vector<Mat4> model_from_node(n);
  std::vector<int> open;
  for (std::size_t i = 0; i < n; ++i)
    if (model.nodes[i].parent < 0) open.push_back(static_cast<int>(i));
  while (!open.empty()) {
    const int i = open.back();
    open.pop_back();
    const Node& node = model.nodes[i];
    const Mat4 local = parent_from_node(node, locals[i]);
    model_from_node[i] = node.parent < 0 ? local : model_from_node[node.parent] * local;
    open.insert(open.end(), node.children.begin(), node.children.end());
  }
  return model_from_node;
}

// A node and all above it, the root first.
struct Chain {
  std::vector<int> nodes;
  std::vector<LocalPose> locals;

  Chain(const Model& model, int node) {
    for (int i = node; i >= 0; i = model.nodes[i].parent) nodes.push_back(i);
    std::reverse(nodes.begin(), nodes.end());
    for (const int i : nodes) locals.push_back(rest_pose(model.nodes[i]));
  }
  // nullptr: another node.
  LocalPose* find(int node) {
    const auto at = std::find(nodes.begin(), nodes.end(), node);
    return at == nodes.end() ? nullptr : &locals[static_cast<std::size_t>(at - nodes.begin())];
  }
  Mat4 model_from_last(const Model& model) const {
    Mat4 out = parent_from_node(model.nodes[nodes[0]], locals[0]);
    for (std::size_t i = 1; i < nodes.size(); ++i)
      out = out * parent_from_node(model.nodes[nodes[i]], locals[i]);
    return out;
  }
};

// nullptr: the rest pose.
const Clip* clip_of(const Model& model, int clip) {
  return clip >= 0 && static_cast<std::size_t>(clip) < model.clips.size() ? &model.clips[clip]
                                                                          : nullptr;
}

}  // namespace

ModelPose evaluate_pose(const Model& model, int clip, double time_s, bool loop) {
  ModelPose pose;
  std::vector<LocalPose> locals = rest_pose(model, pose.morph_weights);
  if (const Clip* chosen = clip_of(model, clip))
    apply_clip(*chosen, clip_time(time_s, chosen->duration_s, loop), locals, pose.morph_weights);
  pose.model_from_node = matrices_of(model, locals);
  return pose;
}

ModelPose evaluate_pose(const Model& model, const NodeKeys& keys, double time_s) {
  ModelPose pose;
  std::vector<LocalPose> locals = rest_pose(model, pose.morph_weights);
  for (std::size_t i = 0; i < keys.nodes.size(); ++i)
    apply(place_at(keys, i, time_s), locals[static_cast<std::size_t>(keys.nodes[i])]);
  pose.model_from_node = matrices_of(model, locals);
  return pose;
}

Mat4 evaluate_node(const Model& model, int node, int clip, double time_s) {
  Chain chain(model, node);
  if (const Clip* chosen = clip_of(model, clip)) {
    std::vector<double> v;
    for (const Channel& channel : chosen->channels) {
      LocalPose* local = chain.find(channel.node);
      if (!local || channel.times_s.empty() || channel.path == Channel::Path::kWeights) continue;
      sample(channel, clip_time(time_s, chosen->duration_s, true), v);
      apply(channel.path, v, *local);
    }
  }
  return chain.model_from_last(model);
}

Mat4 evaluate_node(const Model& model, int node, const NodeKeys& keys, double time_s) {
  Chain chain(model, node);
  for (std::size_t i = 0; i < keys.nodes.size(); ++i)
    if (LocalPose* local = chain.find(keys.nodes[i])) apply(place_at(keys, i, time_s), *local);
  return chain.model_from_last(model);
}

Result<int> find_clip(const Model& model, const std::string& wanted, const std::string& place) {
  const int n_clips = static_cast<int>(model.clips.size());
  for (int i = 0; i < n_clips; ++i)
    if (model.clips[i].name == wanted) return i;
  std::string known;
  for (int i = 0; i < n_clips; ++i) {
    if (wanted == fmt::format("{}", i)) return i;
    known += fmt::format("{}{} {}", i > 0 ? ", " : "", i, model.clips[i].name);
  }
  return refusal(place, fmt::format("\"{}\"", printable(wanted)),
                 n_clips == 0 ? "none, the model has no clips"
                              : "a clip of the model, by name or number: " + printable(known, 300));
}

std::vector<Mat4> joint_matrices(const Model& model, const ModelPose& pose, int skin) {
  const Skin& from = model.skins[skin];
  std::vector<Mat4> out(from.joints.size());
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = pose.model_from_node[from.joints[i]] * from.inverse_bind[i];
  return out;
}

Bounds model_bounds(const Model& model, const ModelPose& pose) {
  Bounds bounds;
  std::size_t n_vertices = 0;
  std::vector<int> open = model.roots;
  while (!open.empty()) {
    const int i = open.back();
    open.pop_back();
    add_node(model, pose, i, n_vertices, bounds);
    open.insert(open.end(), model.nodes[i].children.begin(), model.nodes[i].children.end());
  }
  return bounds;
}

}  // namespace neritic::scene
