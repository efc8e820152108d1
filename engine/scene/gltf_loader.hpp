// Reads glTF 2.0 (.gltf with files or data URIs beside it, .glb) into a Model. Every index, length
// and number is checked: a bad file is an Error (kBadInput) with one line, never a crash. A fault
// that still lets the model be drawn (a missing picture, an optional extension) becomes a note.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "engine/core/result.hpp"
#include "engine/scene/model.hpp"

namespace neritic::scene {

Result<Model> load_gltf(const std::filesystem::path& path);

// The same from bytes already in memory (.gltf or .glb, told apart by content). name stands in
// messages; folder is where relative URIs lead, empty: such URIs are errors.
Result<Model> parse_gltf_bytes(std::span<const std::byte> bytes, const std::string& name,
                               const std::filesystem::path& folder = {});

}  // namespace neritic::scene
