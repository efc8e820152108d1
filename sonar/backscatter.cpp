#include "sonar/backscatter.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/check.hpp"
#include "sonar/acoustics.hpp"
#include "sonar/acoustics_materials.hpp"

namespace neritic::sonar {
namespace {

constexpr std::uint16_t kSeabedClass = 1;  // scene::kClasses
// The material assumed for bottoms with Lambert's -27 dB.
constexpr std::string_view kLambertMaterial = "sand";

template <class Value>
std::vector<float> by_label(const scene::Scene& scene, Value value) {
  std::vector<float> table(1, 0.0f);
  for (const scene::Object& object : scene.objects) {
    const std::size_t end = object.instance + object.instance_count();
    if (table.size() < end) table.resize(end, 0.0f);
    std::fill_n(table.begin() + object.instance, object.instance_count(),
                static_cast<float>(value(object)));
  }
  return table;
}

}  // namespace

double backscatter_strength(const scene::Object& object) {
  if (object.backscatter_db) return power_from_db(*object.backscatter_db);
  if (!object.material.empty()) {
    const auto medium = material_of(object.material);
    NERITIC_CHECK(medium.ok(), "{}: {}", object.name, medium.ok() ? "" : medium.error().message);
    const double r = reflection_coefficient(kReferenceWater, *medium);
    if (object.class_id != kSeabedClass) return kRigidStrength * r * r * object.reflectivity;
    const double sand = reflection_coefficient(kReferenceWater, *material_of(kLambertMaterial));
    return power_from_db(kLambertMu_db) * r * r / (sand * sand) * object.reflectivity;
  }
  const double mu = object.class_id == kSeabedClass ? power_from_db(kLambertMu_db) : kRigidStrength;
  return mu * object.reflectivity;
}

BackscatterTable backscatter_table(const scene::Scene& scene) {
  BackscatterTable out;
  double largest = 0.0;
  for (const scene::Object& object : scene.objects)
    largest = std::max(largest, backscatter_strength(object));
  out.scale = largest > 0.0 ? largest : 1.0;
  out.strength = by_label(
      scene, [&](const scene::Object& object) { return backscatter_strength(object) / out.scale; });
  return out;
}

std::vector<float> reflectivity_table(const scene::Scene& scene) {
  if (std::ranges::all_of(scene.objects,
                          [](const auto& object) { return object.reflectivity == 1.0f; }))
    return {};
  return by_label(scene, [](const scene::Object& object) { return object.reflectivity; });
}

}  // namespace neritic::sonar
