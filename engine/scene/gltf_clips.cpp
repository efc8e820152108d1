// Animations: samplers and channels of every clip. See gltf_stages.hpp. Source: Khronos glTF 2.0
// section 3.11.
#include <algorithm>
#include <cmath>

#include "engine/scene/gltf_stages.hpp"

namespace neritic::scene::gltf {
namespace {

// A matrix has no channels: an animated node that has one gets the translation, rotation and scale
// it consists of (shear is lost; the specification forbids the case).
void decompose(Node& node) {
  if (!node.matrix) return;
  const Mat4 m = *node.matrix;
  node.matrix.reset();
  node.translation_m = Vec3(m[3]);
  Mat3 axes(m);
  for (int k = 0; k < 3; ++k) {
    node.scale[k] = glm::length(axes[k]);
    if (node.scale[k] > 0.0) axes[k] /= node.scale[k];
  }
  if (glm::determinant(axes) < 0.0) {
    node.scale.x = -node.scale.x;
    axes[0] = -axes[0];
  }
  const bool rotation = std::abs(glm::determinant(axes)) > 1e-6;
  node.rotation = rotation ? glm::normalize(glm::quat_cast(axes)) : Quat(1.0, 0.0, 0.0, 0.0);
}

bool parse_interpolation(Field field, Channel& out) {
  const std::string name = field.text("LINEAR");
  if (name == "STEP")
    out.interpolation = Channel::Interpolation::kStep;
  else if (name == "LINEAR")
    out.interpolation = Channel::Interpolation::kLinear;
  else if (name == "CUBICSPLINE")
    out.interpolation = Channel::Interpolation::kCubic;
  else
    field.refuse(fmt::format("\"{}\"", one_line(name, 40)), "STEP, LINEAR or CUBICSPLINE");
  return !field.report().failed();
}

// Where the channel leads. False where it is to be ignored (with a note) or is wrong.
bool parse_target(Loading& loading, Field target, Channel& out) {
  const std::string path = target["path"].text();
  if (path == "translation") {
    out.path = Channel::Path::kTranslation;
  } else if (path == "rotation") {
    out.path = Channel::Path::kRotation;
  } else if (path == "scale") {
    out.path = Channel::Path::kScale;
  } else if (path == "weights") {
    out.path = Channel::Path::kWeights;
  } else {
    target.note_with("path \"{}\" is not supported and ignored", path);
    return false;
  }
  out.node = target["node"].index(loading.model.nodes.size(), "nodes");
  if (out.node < 0) return false;  // the specification's way to say: for extensions only
  out.width = out.path == Channel::Path::kRotation ? 4 : 3;
  if (out.path != Channel::Path::kWeights) return true;
  const int mesh = loading.model.nodes[out.node].mesh;
  out.width = mesh < 0 ? 0 : static_cast<int>(loading.model.meshes[mesh].weights.size());
  if (out.width == 0) target.note_with("weights of a node without morph targets are ignored");
  return out.width > 0;
}

// Unit quaternions; the in- and out-tangents of a cubic spline are no quaternions and stay.
void normalize_rotations(Channel& channel) {
  const bool cubic = channel.interpolation == Channel::Interpolation::kCubic;
  const std::size_t stride = cubic ? 12 : 4;
  for (std::size_t i = cubic ? 4 : 0; i + 4 <= channel.values.size(); i += stride) {
    float* q = &channel.values[i];
    const double length = std::sqrt(double{q[0]} * q[0] + double{q[1]} * q[1] +
                                    double{q[2]} * q[2] + double{q[3]} * q[3]);
    for (int k = 0; k < 4; ++k)
      q[k] = length > 1e-12 ? static_cast<float>(q[k] / length) : (k == 3 ? 1.0f : 0.0f);
  }
}

// Times must start at 0 or later and increase; keys that do not are dropped with a note (an
// accessor without bytes, all zeros, is valid and ends here too).
void keep_increasing(Field input, Channel& channel) {
  if (channel.times_s.empty()) return;
  const std::size_t n = channel.times_s.size(), width = channel.values.size() / n;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const float time_s = channel.times_s[i];
    if (time_s < 0.0f || (kept > 0 && time_s <= channel.times_s[kept - 1])) continue;
    channel.times_s[kept] = time_s;
    std::copy_n(channel.values.begin() + i * width, width, channel.values.begin() + kept * width);
    ++kept;
  }
  if (kept == n) return;
  channel.times_s.resize(kept);
  channel.values.resize(kept * width);
  input.note_with("{} of {} keys whose times do not increase are ignored", n - kept, n);
}

void load_keys(Loading& loading, Field sampler, Channel& out) {
  const Field input = sampler["input"], output = sampler["output"];
  if (!input.present() || !output.present()) {
    sampler.refuse("a sampler without input or output", "one with both");
    return;
  }
  out.times_s = loading.resources.floats(input);
  int components = 0;
  out.values = loading.resources.any(output, components);
  if (loading.report.failed()) return;
  const int expected_components = out.path == Channel::Path::kWeights ? 1 : out.width;
  const bool cubic = out.interpolation == Channel::Interpolation::kCubic;
  const std::size_t expected = out.times_s.size() * out.width * (cubic ? 3 : 1);
  if (components != expected_components || out.values.size() != expected) {
    output.refuse(
        fmt::format("{} values of {} components", out.values.size() / std::max(components, 1),
                    components),
        fmt::format("{} values of {}", expected / expected_components, expected_components));
    return;
  }
  keep_increasing(input, out);
  if (out.path == Channel::Path::kRotation) normalize_rotations(out);
}

Clip load_clip(Loading& loading, Field field) {
  Clip clip;
  clip.name = field["name"].text();
  const Field channels = field["channels"], samplers = field["samplers"];
  for (std::size_t i = 0; i < channels.size() && !loading.report.failed(); ++i) {
    Channel channel;
    const int sampler = channels.at(i)["sampler"].index(samplers.size(), "samplers");
    if (sampler < 0) channels.at(i).refuse("a channel without a sampler", "the index of a sampler");
    if (loading.report.failed()) break;
    if (!parse_target(loading, channels.at(i)["target"], channel)) continue;
    if (!parse_interpolation(samplers.at(sampler)["interpolation"], channel)) break;
    load_keys(loading, samplers.at(sampler), channel);
    if (loading.report.failed() || channel.times_s.empty()) continue;
    if (channel.path != Channel::Path::kWeights) decompose(loading.model.nodes[channel.node]);
    clip.duration_s = std::max(clip.duration_s, double{channel.times_s.back()});
    clip.channels.push_back(std::move(channel));
  }
  return clip;
}

}  // namespace

void load_clips(Loading& loading) {
  const Field animations = loading.root["animations"];
  for (std::size_t i = 0; i < animations.size() && !loading.report.failed(); ++i)
    loading.model.clips.push_back(load_clip(loading, animations.at(i)));
}

}  // namespace neritic::scene::gltf
