// Lights and cameras. See gltf_stages.hpp. Source: KHR_lights_punctual; Khronos glTF 2.0
// section 3.10.
#include <algorithm>
#include <cmath>

#include "engine/scene/gltf_stages.hpp"

namespace neritic::scene::gltf {
namespace {

double positive(Field parent, const char* key) {
  const Field field = parent[key];
  if (!field.present()) parent.fail_with("no {}, a number above 0 is accepted", key);
  const double value = field.number(1.0);
  if (!(value > 0.0) && !parent.report().failed())
    field.fail_with("{} found, a number above 0 is accepted", value);
  return value;
}

void load_spot(Field spot, Light& out) {
  const double outer = spot["outerConeAngle"].number(kPi / 4.0);
  const double inner = spot["innerConeAngle"].number(0.0);
  if (!(outer > 0.0 && outer <= kPi / 2.0 + 1e-6 && inner >= 0.0 && inner < outer)) {
    spot.fail_with("cone angles {} and {} found, 0 <= inner < outer <= pi/2 is accepted", inner,
                   outer);
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
    } else {
      field.fail_with("light type \"{}\" found, directional, point or spot is accepted",
                      one_line(type, 40));
    }
    loading.model.lights.push_back(std::move(light));
  }
}

void load_cameras(Loading& loading) {
  const Field cameras = loading.root["cameras"];
  for (std::size_t i = 0; i < cameras.size() && !loading.report.failed(); ++i) {
    const Field field = cameras.at(i);
    CameraLens lens;
    lens.name = field["name"].text();
    const std::string type = field["type"].text();
    if (type == "perspective") {
      const Field perspective = field["perspective"];
      lens.vertical_fov_rad = std::min(positive(perspective, "yfov"), kPi - 1e-3);
      lens.near_m = positive(perspective, "znear");
      lens.aspect = std::max(0.0, perspective["aspectRatio"].number(0.0));
    } else if (type == "orthographic") {
      lens.perspective = false;
      lens.half_width_m = std::abs(field["orthographic"]["xmag"].number(1.0));
      lens.half_height_m = std::abs(field["orthographic"]["ymag"].number(1.0));
      if (lens.half_width_m == 0.0 || lens.half_height_m == 0.0)
        field["orthographic"].fail("xmag or ymag is 0");
      lens.near_m = field["orthographic"]["znear"].number(0.1);
    } else {
      field.fail_with("camera type \"{}\" found, perspective or orthographic is accepted",
                      one_line(type, 40));
    }
    loading.model.cameras.push_back(std::move(lens));
  }
}

}  // namespace neritic::scene::gltf
