// Any bytes as a compressed mesh: an Error in one line, or as many elements as were asked for. The
// first byte picks Draco, or meshopt's mode, filter and stride. A picture or mesh of a forged size
// is for the budget of glTF to refuse, so that sizes are kept small here.
#include "engine/core/check.hpp"
#include "engine/scene/gltf_draco.hpp"
#include "engine/scene/gltf_meshopt.hpp"
#include "tests/fuzz/replay.hpp"

namespace {
using namespace neritic;
namespace gltf = scene::gltf;

constexpr std::size_t kFaces = 4096, kElements = 3 * 256;

void check_error(const Error& error) {
  NERITIC_CHECK(
      error.message.starts_with("found ") && error.message.find('\n') == error.message.npos, "{}",
      error.message);
}

void try_draco(std::span<const std::byte> bytes) {
  const auto mesh = gltf::DracoMesh::decode(bytes, kFaces);
  if (!mesh.ok()) return check_error(mesh.error());
  const auto indices = mesh->indices();
  NERITIC_CHECK(indices.size() <= 3 * kFaces, "{} indices", indices.size());
  for (const std::uint32_t i : indices) NERITIC_CHECK(i < mesh->points(), "index {}", i);
  for (std::uint32_t id = 0; id < 4; ++id) {
    if (mesh->components(id) <= 0) continue;
    const auto values = mesh->attribute(id, 5126);
    NERITIC_CHECK(values.empty() || values.size() == mesh->points() * mesh->components(id) * 4,
                  "{} bytes", values.size());
  }
}

void try_meshopt(std::size_t kind, std::span<const std::byte> bytes) {
  constexpr const char* kModes[] = {"ATTRIBUTES", "TRIANGLES", "INDICES"};
  constexpr const char* kFilters[] = {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"};
  constexpr std::size_t kStrides[] = {2, 4, 8, 12, 256};
  const gltf::MeshoptStream stream{kElements, kStrides[kind / 12 % 5], kModes[kind % 3],
                                   kFilters[kind / 3 % 4]};
  if (const Status fits = gltf::check_meshopt(stream); !fits.ok()) return check_error(fits.error());
  const auto decoded = gltf::decode_meshopt(stream, bytes);
  if (!decoded.ok()) return check_error(decoded.error());
  NERITIC_CHECK(decoded->size() == stream.count * stream.stride, "{} bytes", decoded->size());
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const auto bytes = fuzz::as_bytes(data + 1, size - 1);
  if (data[0] < 128)
    try_draco(bytes);
  else
    try_meshopt(data[0] - 128u, bytes);
  return 0;
}
