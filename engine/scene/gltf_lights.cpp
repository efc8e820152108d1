// Lights. See gltf_stages.hpp. Source: KHR_lights_punctual.
#include <algorithm>

#include "engine/scene/gltf_stages.hpp"

namespace neritic::scene::gltf {
namespace {

void load_spot(Field spot, Light& out) {
  const double outer = spot["outerConeAngle"].number(kPi / 4.0);
  const double inner = spot["innerConeAngle"].number(0.0);
  if (!(outer > 0.0 && outer <= kPi / 2.0 + 1e-6 && inner >= 0.0 && inner < outer)) {
    spot.refuse(fmt::format("cone angles {} and {}", inner, outer), "0 <= inner < outer <= pi/2");
    return;
  }
  out.inner_cone_rad = static_cast<float>(inner);
  out.outer_cone_rad = static_cast<float>(outer);
}

}  // namespace

void load_lights(Loading& loading) {
  const Field lights = loading.root.extension("KHR_lights_punctual")["lights"];
  for (std::size_t i = 0; i < lights.size() && !loading.report.failed(); ++i) {
    const Field field = lights.at(i);
    Light light;
    light.name = field["name"].text();
    const auto color = field["color"].numbers<3>({1.0, 1.0, 1.0});
    light.color = glm::clamp(Vec3f(color[0], color[1], color[2]), 0.0f, 1.0f);
    // A lighthouse has about 1e6 candela; more than 1e9 is no lamp and would overflow later.
    light.intensity = std::clamp(field["intensity"].number_f(1.0f), 0.0f, 1e9f);
    const std::string type = field["type"].text();
    if (type == "directional") {
      light.kind = Light::Kind::kDirectional;
    } else if (type == "point") {
      light.kind = Light::Kind::kPoint;
    } else if (type == "spot") {
      light.kind = Light::Kind::kSpot;
      load_spot(field["spot"], light);
    } else if (field["type"].present()) {
      // Nodes refer to it by number: it stays, and does not shine.
      field.note_with(
          "light type \"{}\" is not known and ignored; known are directional, point "
          "and spot",
          one_line(type, 40));
      light.intensity = 0.0f;
    } else {
      field.refuse("no type", "directional, point or spot");
    }
    loading.model.lights.push_back(std::move(light));
  }
}

}  // namespace neritic::scene::gltf
