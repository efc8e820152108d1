// The vertex and index streams of a GpuScene while it is made. Rigid meshes are put into clusters.
// Private to GpuScene; rendering thread only.
#pragma once

#include <span>
#include <vector>

#include "engine/render/gpu_scene.hpp"
#include "engine/scene/mesh_levels.hpp"

namespace neritic::render {

struct GpuSceneGeometry {
  gpu::Buffer positions, surfaces, indices, skin, morphs;
};

// Makes of a primitive the data that are uploaded. Pure; any thread.
struct PreparedMesh {
  std::vector<std::uint32_t> indices;  // of its vertices: the mesh, then coarser clusters
  std::vector<ClusterNode> clusters;
  std::vector<scene::MeshLevel> levels;
};
PreparedMesh prepare_mesh(const scene::Primitive& primitive);

class GeometryBuilder {
 public:
  // Appends the primitive's vertices, indices, skin and morph targets, and its coarser levels.
  GpuPrimitive add(const scene::Primitive& primitive, std::uint32_t material,
                   PreparedMesh prepared);
  // Uploads the streams; nothing is added after it. Errors: a stream is larger than the device can
  // read, or there is no memory.
  Result<GpuSceneGeometry> finish(gpu::Device& device);

 private:
  void add_vertex(const scene::Primitive& primitive, std::uint32_t vertex);
  void add_skin(GpuPrimitive& out, const scene::Primitive& primitive,
                std::span<const std::uint32_t> order);
  void add_levels(GpuPrimitive& out, std::span<const std::vector<std::uint32_t>> levels,
                  std::span<const scene::MeshLevel> from);
  void add_morphs(GpuPrimitive& out, const scene::Primitive& primitive);
  Status check_limits(const gpu::Device& device) const;

  std::vector<shared::VertexPosition> positions_;
  std::vector<shared::VertexSurface> surfaces_;
  std::vector<std::uint32_t> indices_;
  std::vector<shared::SkinVertex> skin_;
  std::vector<shared::MorphDelta> morphs_;
  std::uint32_t largest_mesh_ = 0;  // vertices
};

}  // namespace neritic::render
