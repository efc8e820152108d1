#include "engine/scene/small_targets.hpp"

#include <algorithm>

#include "engine/scene/animation.hpp"

namespace neritic::scene {
namespace {

int root_of(const Scene& scene, int object) {
  while (object >= 0 && scene.objects[object].mount.object >= 0)
    object = scene.objects[object].mount.object;
  return object;
}

}  // namespace

double least_target_m(const Scene& scene, const Sonar& sonar) {
  const int carrier = root_of(scene, sonar.mount.object);
  double least_m = 0.0;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    if (object.model < 0 || !object.copies.empty()) continue;
    if (carrier >= 0 && root_of(scene, static_cast<int>(i)) == carrier) continue;
    const Model& model = *scene.models[object.model];
    const Bounds bounds = model_bounds(model, evaluate_pose(model, -1, 0.0));
    if (bounds.empty()) continue;
    const Vec3 size_m = glm::abs((bounds.max - bounds.min) * object.scale);
    const double middle_m =
        std::max(std::min(size_m.x, size_m.y), std::min(std::max(size_m.x, size_m.y), size_m.z));
    if (middle_m > 0.0 && (least_m == 0.0 || middle_m < least_m)) least_m = middle_m;
  }
  return least_m;
}

}  // namespace neritic::scene
