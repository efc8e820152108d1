#include "tools/neritic/load_scene.hpp"

#include <algorithm>
#include <cctype>

#include "engine/scene/gltf_loader.hpp"
#include "tools/neritic/flags.hpp"

namespace neritic::tools {
namespace {

Result<scene::Scene> load(const std::filesystem::path& path, const scene::SceneOptions& options) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  if (extension == ".toml" || extension.empty()) return scene::load_scene(path, options);
  if (extension != ".gltf" && extension != ".glb")
    return bad_input("{}: a {} file; accepted: a scene (.toml) or a model (.gltf, .glb)",
                     path.string(), extension.substr(1));
  NERITIC_TRY(scene::Model model, scene::load_gltf(path));
  scene::Scene scene = scene::scene_of_model(std::move(model), 1280, 720);
  scene.path = path.string();
  scene.title = path.filename().string();
  for (scene::Object& object : scene.objects) object.mount.pose.position_m += options.offset_m;
  for (scene::Camera& camera : scene.cameras) camera.mount.pose.position_m += options.offset_m;
  return scene;
}

}  // namespace

Result<scene::Scene> load_scene_or_model(const std::string& path, const std::string& size,
                                         const scene::SceneOptions& options) {
  NERITIC_TRY(scene::Scene scene, load(path, options));
  if (size.empty()) return scene;
  NERITIC_TRY(const auto extent, parse_size("--size", size));
  for (scene::Camera& camera : scene.cameras)
    camera.width = extent.first, camera.height = extent.second;
  return scene;
}

}  // namespace neritic::tools
