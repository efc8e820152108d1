// A scene or a model file as a subcommand's argument, with the flags that change it.
#pragma once

#include <string>

#include "engine/core/result.hpp"
#include "engine/scene/scene.hpp"

namespace neritic::tools {

// path: .toml, or .gltf / .glb (shown alone, framed by a camera). size: "WxH" of every camera, or
// empty. clip: of a model, by name or number; empty: its first.
Result<scene::Scene> load_scene_or_model(const std::string& path, const std::string& size,
                                         const scene::SceneOptions& options = {},
                                         const std::string& clip = {});

}  // namespace neritic::tools
