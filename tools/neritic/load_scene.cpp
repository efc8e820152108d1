#include "tools/neritic/load_scene.hpp"

#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"
#include "engine/scene/animation.hpp"
#include "engine/scene/gltf_loader.hpp"
#include "tools/neritic/flags.hpp"

namespace neritic::tools {
namespace {

using Extent = std::pair<std::uint32_t, std::uint32_t>;  // pixels across, down

Result<scene::Scene> load(const std::filesystem::path& path, const Extent& model_extent,
                          const scene::SceneOptions& options, const std::string& clip) {
  const std::string extension = lower_case(path.extension().string());
  if (extension == ".toml" || extension.empty()) {
    if (!clip.empty())
      return refusal("--clip", "a scene", "a model (.gltf, .glb); a scene names clips itself");
    return scene::load_scene(path, options);
  }
  if (extension != ".gltf" && extension != ".glb")
    return refusal(path.string(), fmt::format("a {} file", extension.substr(1)),
                   "a scene (.toml) or a model (.gltf, .glb)");
  NERITIC_TRY(scene::Model model, scene::load_gltf(path));
  int chosen = -1;
  if (!clip.empty()) {
    NERITIC_TRY(chosen, scene::find_clip(model, clip, "--clip"));
  }
  scene::Scene scene =
      scene::scene_of_model(std::move(model), model_extent.first, model_extent.second, chosen);
  scene.path = path.string();
  scene.title = path.filename().string();
  for (scene::Object& object : scene.objects) object.mount.pose.position_m += options.offset_m;
  for (scene::Camera& camera : scene.cameras) camera.mount.pose.position_m += options.offset_m;
  return scene;
}

}  // namespace

Result<scene::Scene> load_scene_or_model(const std::string& path, const std::string& size,
                                         const scene::SceneOptions& options,
                                         const std::string& clip) {
  Extent extent{1280, 720};
  if (!size.empty()) {
    NERITIC_TRY(extent, parse_size("--size", size));
  }
  NERITIC_TRY(scene::Scene scene, load(path, extent, options, clip));
  if (size.empty()) return scene;
  for (scene::Camera& camera : scene.cameras)
    camera.width = extent.first, camera.height = extent.second;
  return scene;
}

}  // namespace neritic::tools
