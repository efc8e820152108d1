// Reads glTF 2.0 (.gltf with files or data URIs beside it, .glb) into a Model. Every index, length
// and number is checked: a bad file is an Error (kBadInput) with one line, never a crash.
#pragma once

#include <filesystem>

#include "engine/core/result.hpp"
#include "engine/scene/model.hpp"

namespace neritic::scene {

Result<Model> load_gltf(const std::filesystem::path& path);

}  // namespace neritic::scene
