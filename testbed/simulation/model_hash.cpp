#include "testbed/simulation/model_hash.hpp"

#include "engine/core/hash.hpp"
#include "testbed/simulation/static_scene.hpp"

namespace neritic::testbed {
namespace {

void add_text(Hash64& hash, const std::string& text) {
  hash.add_span(std::span<const char>(text));
}

void add_clip(Hash64& hash, const scene::Clip& clip) {
  hash.add(clip.duration_s);
  hash.add(static_cast<std::uint64_t>(clip.channels.size()));
  for (const scene::Channel& channel : clip.channels) {
    hash.add(channel.node), hash.add(channel.path), hash.add(channel.interpolation);
    hash.add(channel.width);
    hash.add_span(std::span<const float>(channel.times_s));
    hash.add_span(std::span<const float>(channel.values));
  }
}

}  // namespace

std::uint64_t shape_hash(const scene::Model& model, const Vec3& scale) {
  Hash64 hash;
  hash.add_span(std::span<const Vec3>(rest_points(model, scale)));
  hash.add(static_cast<std::uint64_t>(model.meshes.size()));
  for (const scene::Mesh& mesh : model.meshes) {
    hash.add(static_cast<std::uint64_t>(mesh.primitives.size()));
    for (const scene::Primitive& p : mesh.primitives)
      hash.add_span(std::span<const std::uint32_t>(p.indices));
  }
  for (const scene::Node& node : model.nodes) {
    add_text(hash, node.name);
    hash.add(node.translation_m);
  }
  return hash.value();
}

std::uint64_t joints_hash(const scene::Model& model, int clip) {
  Hash64 hash;
  hash.add(static_cast<std::uint64_t>(model.nodes.size()));
  for (const scene::Node& node : model.nodes) {
    add_text(hash, node.name);
    hash.add(node.parent), hash.add(node.translation_m), hash.add(node.rotation);
    hash.add(node.scale), hash.add(node.matrix.has_value());
    if (node.matrix) hash.add(*node.matrix);
  }
  if (clip >= 0) add_clip(hash, model.clips.at(static_cast<std::size_t>(clip)));
  return hash.value();
}

}  // namespace neritic::testbed
