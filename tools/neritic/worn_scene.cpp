#include "tools/neritic/worn_scene.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/core/files.hpp"
#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"
#include "testbed/view/dive_camera.hpp"
#include "tools/common/shipped.hpp"
#include "tools/neritic/load_scene.hpp"

namespace neritic::tools {
namespace {

namespace fs = std::filesystem;

// The eyes of assets/divers/recreational.toml from the hips: towards the crown, and towards the
// chest (diver/reach.hpp).
constexpr double kEyesToCrown_m = 0.786, kEyesToChest_m = 0.09;
constexpr double kLeastDepth_m = 1.0;

// A file of ours, as the scene's file would name it.
Result<std::string> named_from(const std::string& scene, const fs::path& ours) {
  const fs::path found = find_shipped({"assets" / ours, "share/neritic/assets" / ours});
  if (found.empty())
    return failure(ErrorCode::kIo,
                   "{}: a person needs a diver: no assets/{} or share/neritic/assets/{} above the "
                   "program's folder",
                   scene, ours.string(), ours.string());
  std::error_code error;
  const fs::path folder = fs::weakly_canonical(fs::absolute(scene, error).parent_path(), error);
  std::string out;
  for (const char c : fs::weakly_canonical(found, error).lexically_relative(folder).string()) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

std::string free_name(const scene::Scene& scene) {
  std::string name = "wearer";
  const auto taken = [&](const scene::Object& object) { return object.name == name; };
  for (int i = 2; std::ranges::any_of(scene.objects, taken); ++i)
    name = fmt::format("wearer_{}", i);
  return name;
}

Result<std::string> words_of_wearer(const scene::Scene& scene) {
  NERITIC_TRY(const std::string model, named_from(scene.path, "models/diver.glb"));
  NERITIC_TRY(const std::string human, named_from(scene.path, "divers/recreational.toml"));
  const Pose view = scene.world_from(scene.cameras.empty() ? testbed::camera_for(scene).mount
                                                           : scene.cameras.front().mount);
  const double course_rad = testbed::course_of(view.rotation, 0.0);
  Vec3 eyes_m = view.position_m;
  eyes_m.y = std::min(eyes_m.y, -kLeastDepth_m);
  const Vec3 hips_m = eyes_m + from_yaw_pitch_roll(course_rad, 0.0, 0.0) *
                                   Vec3(0.0, kEyesToChest_m, kEyesToCrown_m);
  const std::string name = free_name(scene);
  std::string out = fmt::format(
      R"(
# The diver whom a person is.
{}[[objects]]
name = "{}"
class = "diver"
reflectivity = 0.7
model = "{}"
human = "{}"
position_m = [{:.4f}, {:.4f}, {:.4f}]
yaw_deg = {:.3f}
pitch_deg = -90
[[objects.cameras]]
name = "eyes"
position_m = [0, 0.79, -0.2]
pitch_deg = 90
fov_deg = 75
width = 1280
height = 720
)",
      scene.physics ? "" : "[physics]\n", name, model, human, hips_m.x, hips_m.y, hips_m.z,
      degrees(course_rad));
  if (scene.water && !scene.water->bubbles.empty())
    out += fmt::format(
        R"([[water.bubbles]]
on = "{}"
joint = "head"
position_m = [0, 0.03, -0.165]
diameter_mm = 3.6
)",
        name);
  return out;
}

}  // namespace

bool has_diver(const scene::Scene& scene) {
  return std::ranges::any_of(scene.objects,
                             [](const scene::Object& object) { return object.human.has_value(); });
}

bool is_model(const scene::Scene& scene) {
  const std::string extension = lower_case(fs::path(scene.path).extension().string());
  return extension == ".glb" || extension == ".gltf";
}

Result<WornScene> with_wearer(const scene::Scene& scene, const std::string& size) {
  if (is_model(scene))
    return refusal(scene.path, "a model, in which nobody can dive", "a scene (.toml)");
  NERITIC_TRY(std::string text, read_text(scene.path));
  NERITIC_TRY(const std::string wearer, words_of_wearer(scene));
  text += "\n" + wearer;
  NERITIC_TRY(scene::Scene worn, load_scene_or_model(scene.path, size, {.text = text}));
  return WornScene{std::move(worn), std::move(text)};
}

}  // namespace neritic::tools
