// A scene on the GPU: vertex and index streams of every mesh, textures, materials, and the list of
// what is drawn, grouped so that all instances of one primitive are one draw. Made once per scene;
// owned by the rendering thread.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "engine/core/result.hpp"
#include "engine/gpu/device.hpp"
#include "engine/gpu/pipeline.hpp"
#include "engine/gpu/resources.hpp"
#include "engine/render/clusters.hpp"
#include "engine/scene/object_pictures.hpp"
#include "engine/scene/scene.hpp"
#include "shared/raster.h"

namespace neritic::render {

inline constexpr std::uint32_t kNone = ~0u;

struct GpuMaterial {
  VkDescriptorSet set = VK_NULL_HANDLE;
  std::uint32_t flags = 0;  // shared::kMaterial...
  bool double_sided = false, mask = false, blend = false, emissive = false;
  std::uint32_t picture = kNone;  // of GpuScene::pictures: it glows with that
};

// The image of a picture that changes (scene::ObjectPictures); black at first.
struct GpuPicture {
  std::uint32_t place = 0;            // an index into the places that the scene was made with
  const gpu::Image* image = nullptr;  // sRGB with all mips
  std::uint64_t number = 0;           // of the picture that it has; 0: none
};

// A coarser version of a primitive (engine/scene/mesh_levels.hpp).
struct GpuLevel {
  std::uint32_t first_index = 0, index_count = 0;
  std::uint32_t vertex_count = 0;  // of a skinned primitive: it uses none of those after these
  double error_m = 0.0;            // in the mesh's frame
};

// A box round the vertices, at rest, that a joint moves.
struct JointBound {
  std::uint32_t joint = 0;  // of the skin
  Vec3 center_m{0.0}, half_m{0.0};
};

struct GpuPrimitive {
  scene::Topology topology = scene::Topology::kTriangles;
  std::uint32_t first_index = 0, index_count = 0;
  std::uint32_t first_vertex = 0, vertex_count = 0;
  std::uint32_t material = 0;
  std::uint32_t first_skin = kNone;  // in the skin stream
  std::uint32_t first_morph = 0, morph_targets = 0;
  Vec3 center_m{0.0};  // bounding sphere in the mesh's frame, rest shape
  double radius_m = 0.0;
  Vec3 half_m{0.0};                      // of the bounding box round the same centre
  std::vector<ClusterNode> clusters;     // empty: drawn whole
  std::vector<GpuLevel> levels;          // coarser and coarser
  std::vector<JointBound> joint_bounds;  // skinned without morph targets; else empty
  bool closed =
      false;  // rigid, and nobody outside it sees a back face; only told in scenes with sonars
  bool deforms() const { return first_skin != kNone || morph_targets > 0; }
};

// One appearance of a primitive: object, its model's node, and which copies.
struct Appearance {
  std::uint32_t object = 0, node = 0;
  int copy = -1;           // of Object::copies; -1: the object itself
  int node_instance = -1;  // of Node::instances
  std::uint16_t label = 0;
};

struct DrawGroup {
  GpuPrimitive primitive;
  std::vector<Appearance> appearances;
};

class GpuScene {
 public:
  // Uploads everything the scene's objects use. material_layout: set 1 of the raster pipelines.
  // places: where objects show pictures that change; those whose model has no such material cost
  // nothing.
  static Result<std::unique_ptr<GpuScene>> create(gpu::Device& device, const scene::Scene& scene,
                                                  VkDescriptorSetLayout material_layout,
                                                  std::span<const scene::PicturePlace> places = {});

  ~GpuScene();

  const gpu::Buffer& positions() const;
  const gpu::Buffer& surfaces() const;
  const gpu::Buffer& indices() const;
  const gpu::Buffer& skin() const;
  const gpu::Buffer& morphs() const;
  const std::vector<GpuMaterial>& materials() const;
  // One a place that some material has.
  std::span<GpuPicture> pictures();
  const std::vector<DrawGroup>& groups() const { return groups_; }
  bool has_emission() const;
  bool has_thin() const;  // some material lets diffuse light through
  std::uint64_t triangles() const { return triangles_; }  // of all appearances

 private:
  friend class GpuSceneBuilder;
  struct Parts;
  GpuScene();
  std::unique_ptr<Parts> parts_;
  std::vector<DrawGroup> groups_;
  std::uint64_t triangles_ = 0;
};

// Set 1 of the raster pipelines.
Result<gpu::SetLayout> create_material_layout(const gpu::Device& device);

}  // namespace neritic::render
