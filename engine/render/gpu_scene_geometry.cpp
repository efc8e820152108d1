#include "engine/render/gpu_scene_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <numeric>

#include "engine/gpu/frames.hpp"
#include "shared/octahedral.h"

namespace neritic::render {
namespace {

std::uint32_t pack_normal(const Vec3f& n) {
  const float size = glm::length(n);
  const Vec3f unit = size > 1e-20f && std::isfinite(size) ? n / size : Vec3f(0.0f, 1.0f, 0.0f);
  return glm::packSnorm2x16(shared::octahedral_encode(unit));
}

// Octahedral x in the low 16 bits, sign of the bitangent in bit 16, y in the upper 15
// (gbuffer.vert).
std::uint32_t pack_tangent(const Vec4f& t) {
  const float size = glm::length(Vec3f(t));
  if (!(size > 1e-20f) || !std::isfinite(size)) return 0x80008000u | 0x10000u;
  const Vec2f e = shared::octahedral_encode(Vec3f(t) / size) * 0.5f + 0.5f;
  const auto x = static_cast<std::uint32_t>(std::lround(glm::clamp(e.x, 0.0f, 1.0f) * 65535.0f));
  const auto y = static_cast<std::uint32_t>(std::lround(glm::clamp(e.y, 0.0f, 1.0f) * 32767.0f));
  return x | (t.w > 0.0f ? 0x10000u : 0u) | y << 17;
}

// The vertices in the order in which the indices first name them (unnamed ones last), so that a
// cluster's lie together; the indices are changed to match. Vertex caches of a processor's driver
// are small tables by index.
std::vector<std::uint32_t> order_by_use(std::vector<std::uint32_t>& indices, std::size_t vertices) {
  std::vector<std::uint32_t> order, place(vertices, kNone);
  order.reserve(vertices);
  const auto placed = [&](std::uint32_t vertex) {
    if (place[vertex] == kNone) {
      place[vertex] = static_cast<std::uint32_t>(order.size());
      order.push_back(vertex);
    }
    return place[vertex];
  };
  for (std::uint32_t& index : indices) index = placed(index);
  for (std::uint32_t v = 0; v < vertices; ++v) placed(v);
  return order;
}

// Boxes round what each joint moves: a skinned vertex lies between the places to which its joints
// alone would bring it.
std::vector<JointBound> bounds_of_joints(const scene::Primitive& p) {
  std::vector<scene::Bounds> boxes;
  for (std::size_t v = 0; v < p.positions.size(); ++v)
    for (int k = 0; k < 4; ++k) {
      if (!(p.weights[v][k] > 0.0f)) continue;
      const std::size_t joint = p.joints[v][static_cast<std::size_t>(k)];
      if (joint >= boxes.size()) boxes.resize(joint + 1);
      boxes[joint].add(Vec3(p.positions[v]));
    }
  std::vector<JointBound> out;
  for (std::uint32_t joint = 0; joint < boxes.size(); ++joint)
    if (const scene::Bounds& box = boxes[joint]; !box.empty())
      out.push_back({joint, 0.5 * (box.min + box.max), 0.5 * (box.max - box.min)});
  return out;
}

template <class T>
Result<gpu::Buffer> filled(gpu::Device& device, const char* name, const std::vector<T>& data,
                           VkBufferUsageFlags usage) {
  NERITIC_TRY(auto buffer, gpu::Buffer::create(device, {name, data.size() * sizeof(T),
                                                        usage | VK_BUFFER_USAGE_TRANSFER_DST_BIT}));
  if (!data.empty())
    NERITIC_TRY_STATUS(gpu::upload_buffer(device, buffer, std::as_bytes(std::span(data))));
  return buffer;
}

}  // namespace

PreparedMesh prepare_mesh(const scene::Primitive& p) {
  // A larger mesh surrounds the camera: parts of it are near, others far.
  constexpr double kLargest_m = 12.0;
  PreparedMesh out;
  out.indices = p.indices;
  const bool large = !p.bounds.empty() && glm::length(p.bounds.max - p.bounds.min) > kLargest_m;
  if (p.topology == scene::Topology::kTriangles && p.joints.empty() && p.targets.empty()) {
    out.clusters = build_clusters(p.positions, out.indices);
    if (large) add_coarse_clusters(p, out.clusters, out.indices);
  }
  if (!large || out.clusters.empty()) out.levels = scene::mesh_levels(p);
  return out;
}

GpuPrimitive GeometryBuilder::add(const scene::Primitive& p, std::uint32_t material,
                                  PreparedMesh prepared) {
  GpuPrimitive g;
  g.topology = p.topology;
  g.first_index = static_cast<std::uint32_t>(indices_.size());
  g.index_count = static_cast<std::uint32_t>(p.indices.size());
  g.first_vertex = static_cast<std::uint32_t>(positions_.size());
  g.vertex_count = static_cast<std::uint32_t>(p.positions.size());
  g.material = material;
  largest_mesh_ = std::max(largest_mesh_, g.vertex_count);
  std::vector<std::uint32_t>& indices = prepared.indices;
  std::vector<std::uint32_t> order;
  std::vector<std::vector<std::uint32_t>> coarser;
  for (const scene::MeshLevel& level : prepared.levels) coarser.push_back(level.indices);
  if (p.topology == scene::Topology::kTriangles && p.joints.empty() && p.targets.empty()) {
    g.clusters = std::move(prepared.clusters);
    order = order_by_use(indices, p.positions.size());
    std::vector<std::uint32_t> place(order.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) place[order[i]] = i;
    for (std::vector<std::uint32_t>& level : coarser)
      for (std::uint32_t& index : level) index = place[index];
  } else if (!coarser.empty()) {
    // The coarsest level's vertices first, so that a level deforms no others.
    std::vector<std::uint32_t> all;
    for (std::size_t i = coarser.size(); i-- > 0;)
      all.insert(all.end(), coarser[i].begin(), coarser[i].end());
    all.insert(all.end(), indices.begin(), indices.end());
    order = order_by_use(all, p.positions.size());
    std::size_t at = 0;
    const auto take = [&](std::vector<std::uint32_t>& out) {
      std::copy_n(all.begin() + static_cast<std::ptrdiff_t>(at), out.size(), out.begin());
      at += out.size();
    };
    for (std::size_t i = coarser.size(); i-- > 0;) take(coarser[i]);
    take(indices);
  } else {
    order.resize(p.positions.size());
    std::iota(order.begin(), order.end(), 0u);
  }
  indices_.insert(indices_.end(), indices.begin(), indices.end());
  add_levels(g, coarser, prepared.levels);
  for (const std::uint32_t vertex : order) add_vertex(p, vertex);
  add_skin(g, p, order);
  add_morphs(g, p);
  if (!p.bounds.empty()) {
    g.center_m = (p.bounds.min + p.bounds.max) * 0.5;
    g.half_m = (p.bounds.max - p.bounds.min) * 0.5;
    g.radius_m = glm::length(g.half_m);
  }
  return g;
}

void GeometryBuilder::add_vertex(const scene::Primitive& p, std::uint32_t i) {
  positions_.push_back({p.positions[i], pack_normal(p.normals[i])});
  shared::VertexSurface s{};
  if (!p.uv0.empty()) s.uv0 = p.uv0[i];
  if (!p.uv1.empty()) s.uv1 = p.uv1[i];
  s.tangent = pack_tangent(p.tangents.empty() ? Vec4f(0.0f) : p.tangents[i]);
  const Vec4f color = p.colors.empty() ? Vec4f(1.0f) : p.colors[i];
  s.color_rg = glm::packUnorm2x16(Vec2f(color.x, color.y));
  s.color_ba = glm::packUnorm2x16(Vec2f(color.z, color.w));
  surfaces_.push_back(s);
}

void GeometryBuilder::add_levels(GpuPrimitive& g,
                                 std::span<const std::vector<std::uint32_t>> levels,
                                 std::span<const scene::MeshLevel> from) {
  for (std::size_t i = 0; i < levels.size(); ++i) {
    GpuLevel& level = g.levels.emplace_back();
    level.first_index = static_cast<std::uint32_t>(indices_.size());
    level.index_count = static_cast<std::uint32_t>(levels[i].size());
    for (const std::uint32_t index : levels[i])
      level.vertex_count = std::max(level.vertex_count, index + 1);
    level.error_m = from[i].error_m;
    indices_.insert(indices_.end(), levels[i].begin(), levels[i].end());
  }
}

void GeometryBuilder::add_skin(GpuPrimitive& g, const scene::Primitive& p,
                               std::span<const std::uint32_t> order) {
  if (p.joints.empty()) return;
  if (p.targets.empty()) g.joint_bounds = bounds_of_joints(p);
  g.first_skin = static_cast<std::uint32_t>(skin_.size());
  for (const std::uint32_t i : order) {
    const auto& j = p.joints[i];
    skin_.push_back(
        {j[0] | std::uint32_t{j[1]} << 16, j[2] | std::uint32_t{j[3]} << 16, p.weights[i]});
  }
}

void GeometryBuilder::add_morphs(GpuPrimitive& g, const scene::Primitive& p) {
  g.first_morph = static_cast<std::uint32_t>(morphs_.size());
  g.morph_targets = static_cast<std::uint32_t>(p.targets.size());
  for (const scene::MorphTarget& target : p.targets)
    for (std::size_t i = 0; i < p.positions.size(); ++i)
      morphs_.push_back({target.positions.empty() ? Vec3f(0.0f) : target.positions[i],
                         target.normals.empty() ? Vec3f(0.0f) : target.normals[i]});
}

// Vertices and indices are numbered in 32 bits; what the deform pass reads is bound as one storage
// buffer. Larger ones would lose the device or draw nothing, without a word.
Status GeometryBuilder::check_limits(const gpu::Device& device) const {
  constexpr std::size_t kNumbers = kNone;
  if (positions_.size() >= kNumbers || indices_.size() >= kNumbers)
    return failure(ErrorCode::kUnsupported,
                   "the scene's meshes have {} vertices and {} indices; fewer than {} of each are "
                   "accepted",
                   positions_.size(), indices_.size(), kNumbers);
  const std::uint32_t highest = device.limits().maxDrawIndexedIndexValue;
  if (largest_mesh_ > highest)
    return failure(ErrorCode::kUnsupported, "a mesh of {} vertices; {} draws at most {}",
                   largest_mesh_, device.info().name, highest);
  if (skin_.empty() && morphs_.empty()) return {};
  const std::size_t limit = device.limits().maxStorageBufferRange;
  const std::size_t largest =
      std::max({positions_.size() * sizeof(positions_[0]), skin_.size() * sizeof(skin_[0]),
                morphs_.size() * sizeof(morphs_[0])});
  if (largest > limit)
    return failure(ErrorCode::kUnsupported,
                   "a scene with skins or morph targets: its meshes' vertices take {} bytes in one "
                   "buffer, {} reads at most {}",
                   largest, device.info().name, limit);
  return {};
}

Result<GpuSceneGeometry> GeometryBuilder::finish(gpu::Device& device) {
  NERITIC_TRY_STATUS(check_limits(device));
  constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                               kVertex = VK_BUFFER_USAGE_VERTEX_BUFFER_BIT;
  GpuSceneGeometry out;
  NERITIC_TRY(out.positions, filled(device, "positions", positions_, kVertex | kStorage));
  NERITIC_TRY(out.surfaces, filled(device, "surfaces", surfaces_, kVertex));
  NERITIC_TRY(out.indices, filled(device, "indices", indices_, VK_BUFFER_USAGE_INDEX_BUFFER_BIT));
  NERITIC_TRY(out.skin, filled(device, "skin", skin_, kStorage));
  NERITIC_TRY(out.morphs, filled(device, "morphs", morphs_, kStorage));
  return out;
}

}  // namespace neritic::render
