// The scene that shows one model: a camera that frames it, the model's own lights or a sun, no
// water. Pure; any thread.
#include <algorithm>
#include <cmath>

#include "engine/scene/animation.hpp"
#include "engine/scene/model_lights.hpp"
#include "engine/scene/scene.hpp"

namespace neritic::scene {
namespace {

constexpr double kVerticalFov_rad = radians(40.0);
constexpr double kMargin = 1.12;  // the model fills about nine tenths of the picture
// Exposure is set for no less light than this: a candela at a kilometre.
constexpr double kDarkest_lx = 1e-6;

constexpr int kFramedInstants = 8;  // of a clip, whose whole course stays in the picture

// The bounds that the camera must show. Nothing drawn, or bounds that are not numbers: a metre
// around the origin.
Bounds bounds_to_frame(const Model& model, int clip) {
  Bounds bounds = model_bounds(model, evaluate_pose(model, clip, 0.0));
  for (int i = 1; clip >= 0 && i < kFramedInstants; ++i) {
    const double time_s = model.clips[clip].duration_s * i / kFramedInstants;
    const Bounds then = model_bounds(model, evaluate_pose(model, clip, time_s));
    if (then.empty()) continue;
    bounds.add(then.min);
    bounds.add(then.max);
  }
  if (bounds.empty() || !is_finite(bounds.min) || !is_finite(bounds.max))
    bounds = {Vec3(-0.5), Vec3(0.5)};
  const double size = glm::length(bounds.max - bounds.min);
  if (size > 0.0) return bounds;
  // One point: a picture as wide as its distance from the origin, or a metre.
  const double half = 0.5 * std::max(1.0, glm::length(bounds.min) * 1e-3);
  return {bounds.min - half, bounds.max + half};
}

// Distance along view_from_world's z at which every corner is inside the frustum.
double distance_to_frame(const Bounds& bounds, const Quat& world_from_view,
                         const FrustumTangents& tangents) {
  const Vec3 centre = 0.5 * (bounds.min + bounds.max);
  double distance_m = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p((corner & 1 ? bounds.max : bounds.min).x, (corner & 2 ? bounds.max : bounds.min).y,
                 (corner & 4 ? bounds.max : bounds.min).z);
    const Vec3 in_view = glm::conjugate(world_from_view) * (p - centre);
    const double across =
        std::max(std::abs(in_view.x) / tangents.right, std::abs(in_view.y) / tangents.top);
    distance_m = std::max(distance_m, in_view.z + across * kMargin);
  }
  return distance_m;
}

}  // namespace

Scene scene_of_model(Model model, std::uint32_t width, std::uint32_t height, int clip) {
  Scene scene;
  scene.title = model.name;
  scene.path = model.name;
  for (const std::string& note : model.notes) scene.notes.push_back(model.name + ": " + note);
  for (const ClassName& known : kClasses) scene.class_names[known.id] = known.name;

  Object object;
  object.name = "model";
  object.model = 0;
  object.class_id = 12;  // target
  object.instance = 1;
  object.clip = model.clips.empty() ? -1 : std::max(clip, 0);

  Camera camera;
  camera.name = "camera";
  camera.width = width;
  camera.height = height;
  camera.vertical_fov_rad = kVerticalFov_rad;
  camera.antialias = true;
  const Bounds bounds = bounds_to_frame(model, object.clip);
  const Vec3 centre = 0.5 * (bounds.min + bounds.max);
  // Three-quarter view: glTF's models face +Z; from the front, their left and above.
  const Vec3 towards_eye = glm::normalize(Vec3(0.6, 0.4, 1.0));
  const Quat world_from_view = look_at(towards_eye, Vec3(0.0)).rotation;
  const double aspect = static_cast<double>(width) / std::max(1u, height);
  const double distance_m =
      distance_to_frame(bounds, world_from_view, tangents_from_fov(kVerticalFov_rad, aspect));
  camera.mount.pose = {centre + towards_eye * distance_m, world_from_view};
  camera.near_m = distance_m * 1e-3;

  scene.models.push_back(std::make_shared<const Model>(std::move(model)));
  scene.objects.push_back(std::move(object));
  choose_model_lights(scene);
  if (scene.model_lights.empty()) {
    scene.sun = Sun{radians(50.0), radians(190.0), 1.0};  // from behind the camera's left shoulder
  } else {
    // A white surface in the model's middle comes out white, whatever the size of the model.
    const double light_lx =
        model_light_lx(scene, centre, 0.5 * glm::distance(bounds.min, bounds.max));
    camera.exposure.fixed_ev = -std::log2(kPi / std::max(light_lx, kDarkest_lx));
  }
  scene.cameras.push_back(std::move(camera));
  return scene;
}

}  // namespace neritic::scene
