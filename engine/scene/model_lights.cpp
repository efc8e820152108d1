#include "engine/scene/model_lights.hpp"

#include <algorithm>

#include "engine/scene/animation.hpp"

namespace neritic::scene {
namespace {

const Model& model_of(const Scene& scene, const ModelLight& light) {
  return *scene.models[static_cast<std::size_t>(scene.objects[light.object].model)];
}

float brightness(const Light& light) {
  return light.intensity * std::max({light.color.x, light.color.y, light.color.z});
}

// Nodes with a light that the model's default scene shows.
std::vector<int> lit_nodes(const Model& model) {
  std::vector<int> lit, open(model.roots.rbegin(), model.roots.rend());
  while (!open.empty()) {
    const int n = open.back();
    open.pop_back();
    const Node& node = model.nodes[static_cast<std::size_t>(n)];
    open.insert(open.end(), node.children.rbegin(), node.children.rend());
    if (node.light >= 0 && brightness(model.lights[static_cast<std::size_t>(node.light)]) > 0.0f)
      lit.push_back(n);
  }
  return lit;
}

// Candidates of one kind (directional or not), and how many there are in all.
struct Candidates {
  std::vector<ModelLight> lights;
  std::size_t count = 0;

  // The node's light on every copy of the object; of one node's alike lights no more than may shine
  // are kept.
  void add(const Scene& scene, std::size_t object, int node) {
    const std::size_t copies = scene.objects[object].copies.size();
    count += std::max<std::size_t>(copies, 1);
    if (copies == 0) lights.push_back({object, -1, node});
    for (std::size_t c = 0; c < std::min(copies, kMaxLamps); ++c)
      lights.push_back({object, static_cast<int>(c), node});
  }

  // The brightest that there is room for; of equals the first in the scene's order.
  void keep_brightest(const Scene& scene, std::size_t room) {
    std::stable_sort(lights.begin(), lights.end(), [&](const ModelLight& a, const ModelLight& b) {
      return brightness(light_of(scene, a)) > brightness(light_of(scene, b));
    });
    lights.resize(std::min(lights.size(), room));
  }
};

}  // namespace

const Light& light_of(const Scene& scene, const ModelLight& light) {
  const Model& model = model_of(scene, light);
  return model
      .lights[static_cast<std::size_t>(model.nodes[static_cast<std::size_t>(light.node)].light)];
}

void choose_model_lights(Scene& scene) {
  Candidates lamps, suns;
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    if (scene.objects[o].model < 0) continue;
    for (const int node : lit_nodes(model_of(scene, {o, -1, 0}))) {
      const bool sun = light_of(scene, {o, -1, node}).kind == Light::Kind::kDirectional;
      (sun ? suns : lamps).add(scene, o, node);
    }
  }
  lamps.keep_brightest(scene, kMaxLamps - std::min(scene.lamps.size(), kMaxLamps));
  suns.keep_brightest(scene, scene.sun ? 0 : 1);
  if (lamps.count > lamps.lights.size())
    scene.notes.push_back(
        fmt::format("{}: {} lamps and {} lights of models; the {} brightest of the models' shine",
                    scene.path, scene.lamps.size(), lamps.count, lamps.lights.size()));
  if (suns.count > suns.lights.size())
    scene.notes.push_back(fmt::format(
        "{}: {} directional lights of models; {}", scene.path, suns.count,
        scene.sun ? "the scene's own sun shines instead" : "the brightest of them is the sun"));
  scene.model_lights = std::move(lamps.lights);
  scene.model_lights.insert(scene.model_lights.end(), suns.lights.begin(), suns.lights.end());
}

double model_light_lx(const Scene& scene, const Vec3& point_m, double nearest_m) {
  double sum = 0.0;
  for (const ModelLight& placed : scene.model_lights) {
    const Object& object = scene.objects[placed.object];
    const Light& light = light_of(scene, placed);
    if (light.kind == Light::Kind::kDirectional) {
      sum += brightness(light);
      continue;
    }
    const ModelPose pose =
        evaluate_pose(model_of(scene, placed), object.clip, object.clip_offset_s);
    const Mat4 world_from_light =
        scene.world_from_copy(object, static_cast<std::size_t>(std::max(placed.copy, 0))) *
        pose.model_from_node[static_cast<std::size_t>(placed.node)];
    const double distance_m =
        std::max(glm::distance(Vec3(world_from_light[3]), point_m), nearest_m);
    sum += brightness(light) / (distance_m * distance_m);
  }
  return sum;
}

}  // namespace neritic::scene
