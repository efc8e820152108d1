#include "tools/neritic/load_scene.hpp"

#include "engine/scene/gltf_loader.hpp"
#include "tools/neritic/flags.hpp"

namespace neritic::tools {
namespace {

Result<scene::Scene> load(const std::filesystem::path& path, const scene::SceneOptions& options) {
  if (path.extension() != ".gltf" && path.extension() != ".glb") return scene::load_scene(path, options);
  NERITIC_TRY(scene::Model model, scene::load_gltf(path));
  scene::Scene scene = scene::scene_of_model(std::move(model), 1280, 720);
  scene.path = path.string();
  scene.title = path.filename().string();
  return scene;
}

}  // namespace

Result<scene::Scene> load_scene_or_model(const std::string& path, const std::string& size, const scene::SceneOptions& options) {
  NERITIC_TRY(scene::Scene scene, load(path, options));
  if (size.empty()) return scene;
  NERITIC_TRY(const auto extent, parse_size("--size", size));
  for (scene::Camera& camera : scene.cameras) camera.width = extent.first, camera.height = extent.second;
  return scene;
}

}  // namespace neritic::tools
