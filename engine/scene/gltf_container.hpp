// The container of a glTF file's JSON: the chunks of a .glb and the URIs of buffers and images.
// Pure functions apart from reading the named file. Source: Khronos glTF 2.0, sections 2.8 and 4.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "engine/core/result.hpp"

namespace neritic::scene::gltf {

struct Container {
  std::string_view json;           // borrows the file's bytes, as does
  std::span<const std::byte> bin;  // empty where there is none
  bool binary = false;             // a .glb
};

// Told apart by content, not by name. Errors do not name the file.
Result<Container> open_container(std::span<const std::byte> bytes);

// The bytes behind a URI: a data URI, or a file below folder. Refused: other schemes, absolute
// paths, paths that leave the folder. An empty folder stands for "no files".
Result<std::vector<std::byte>> read_uri(std::string_view uri, const std::filesystem::path& folder);

}  // namespace neritic::scene::gltf
