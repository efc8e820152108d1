// Meshes in Draco streams (KHR_draco_mesh_compression): decoded and handed to the accessors that
// describe them, so that the mesh stage reads those as any others. Source: the extension's text;
// Draco Bitstream Specification 2.2.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "engine/core/result.hpp"
#include "engine/scene/gltf_stages.hpp"

namespace neritic::scene::gltf {

class DracoMesh {
 public:
  // A stream of more faces than max_faces is refused before it is decoded. Errors name no place.
  static Result<DracoMesh> decode(std::span<const std::byte> bytes, std::size_t max_faces);
  DracoMesh(DracoMesh&&) noexcept;
  ~DracoMesh();

  std::size_t points() const;
  // Three a face, each below points().
  std::vector<std::uint32_t> indices() const;
  // How many numbers a point of the attribute with this id has, 0 where there is none.
  int components(std::uint32_t id) const;
  // The attribute of every point, in glTF's component type (5120 to 5126). Empty where the stream
  // has no value for a point. Precondition: components(id) > 0.
  std::vector<std::byte> attribute(std::uint32_t id, std::uint32_t component_type) const;

 private:
  struct Decoded;
  explicit DracoMesh(std::unique_ptr<Decoded> decoded);
  std::unique_ptr<Decoded> decoded_;
};

// Decodes the primitive's stream where it has one and supplies its accessors. Fails in the report.
void unpack_draco(Loading& loading, Field primitive);

}  // namespace neritic::scene::gltf
