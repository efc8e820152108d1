// Buffer views compressed by EXT_meshopt_compression. Pure. Source: the extension's text.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "engine/core/result.hpp"

namespace neritic::scene::gltf {

struct MeshoptStream {
  std::size_t count = 0, stride = 0;  // elements; bytes of an element
  std::string mode, filter = "NONE";  // as in the file
};

// The stream's values are in range for its mode and filter.
Status check_meshopt(const MeshoptStream& stream);
// count * stride bytes. Precondition: check_meshopt. Errors name no place.
Result<std::vector<std::byte>> decode_meshopt(const MeshoptStream& stream,
                                              std::span<const std::byte> bytes);

}  // namespace neritic::scene::gltf
