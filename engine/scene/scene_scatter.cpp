// Scatters copies of an object over an area, standing on another object's surface where one is
// named. Every draw depends on (seed, object's name, copy, attempt) only. One thread.
#include <glm/gtc/matrix_transform.hpp>
#include <map>

#include "engine/core/hash.hpp"
#include "engine/core/random.hpp"
#include "engine/core/refusal.hpp"
#include "engine/scene/scene_draft.hpp"
#include "engine/scene/scene_surface.hpp"

namespace neritic::scene {
namespace {

constexpr std::uint64_t kMaxAttempts = 256;
constexpr std::uint64_t kDrawsPerAttempt = 8;  // x, z, yaw, scale and room for more

bool kept_out(const ScatterDraft& scatter, double x_m, double z_m) {
  for (const ScatterDraft::KeepOut& disc : scatter.keep_out)
    if (std::hypot(x_m - disc.x_m, z_m - disc.z_m) < disc.radius_m) return true;
  return false;
}

// The shortest turn that takes +Y to the unit vector normal (normal.y > 0 here).
Quat up_to(const Vec3& normal) {
  const Vec3 axis = glm::cross(Vec3(0, 1, 0), normal);
  return glm::normalize(Quat(1.0 + normal.y, axis.x, axis.y, axis.z));
}

// One copy, or nothing where no attempt found a place.
std::optional<Mat4> draw_copy(const ScatterDraft& scatter, const Surface* surface,
                              const RandomKey& key, std::uint64_t copy) {
  for (std::uint64_t attempt = 0; attempt < kMaxAttempts; ++attempt) {
    const std::uint64_t first = (copy * kMaxAttempts + attempt) * kDrawsPerAttempt;
    const auto draw = [&](std::uint64_t i, double min, double max) {
      return min + random_uniform(key, first + i) * (max - min);
    };
    const double x = draw(0, scatter.x_min_m, scatter.x_max_m);
    const double z = draw(1, scatter.z_min_m, scatter.z_max_m);
    if (kept_out(scatter, x, z)) continue;
    SurfacePoint point;
    if (surface) {
      const auto hit = surface->at(x, z);
      if (!hit) continue;
      point = *hit;
    }
    const double scale = draw(3, scatter.scale_min, scatter.scale_max);
    Quat rotation = glm::angleAxis(draw(2, 0.0, 2.0 * kPi), Vec3(0, 1, 0));
    if (scatter.align_to_surface) rotation = up_to(point.normal) * rotation;
    const Vec3 position(x, point.y_m - scatter.sink_m * scale, z);
    return glm::scale(to_matrix({position, rotation}), Vec3(scale));
  }
  return std::nullopt;
}

std::uint64_t stream_of(const std::string& name) {
  Hash64 hash;
  hash.add_bytes(name.data(), name.size());
  return hash.value();
}

// Where the copies of an object stand in the world.
std::vector<Mat4> world_from_models(const SceneDraft& draft,
                                    const std::vector<std::shared_ptr<const Model>>& models,
                                    int index) {
  const Object& object = draft.objects[static_cast<std::size_t>(index)].object;
  const Mat4 world_from_object = to_matrix(world_from_carrier(draft, models, {.object = index}));
  std::vector<Mat4> out;
  if (object.copies.empty()) out.push_back(glm::scale(world_from_object, object.scale));
  for (const Mat4& copy : object.copies)
    out.push_back(world_from_object * glm::scale(copy, object.scale));
  return out;
}

}  // namespace

Status scatter_all(SceneDraft& draft, const std::vector<std::shared_ptr<const Model>>& models) {
  std::map<std::string, Surface> surfaces;
  for (ObjectDraft& object : draft.objects) {
    if (!object.scatter) continue;
    const ScatterDraft& scatter = *object.scatter;
    const Surface* surface = nullptr;
    if (!scatter.on.empty()) {
      int on = -1;
      for (std::size_t i = 0; i < draft.objects.size(); ++i)
        if (draft.objects[i].object.name == scatter.on) on = static_cast<int>(i);
      const ObjectDraft* ground = on < 0 ? nullptr : &draft.objects[static_cast<std::size_t>(on)];
      if (!ground || ground->scatter || !ground->request)
        return refusal(fmt::format("{}.on", scatter.place), fmt::format("\"{}\"", scatter.on),
                       "the name of an object that is drawn, not scattered");
      auto at = surfaces.find(scatter.on);
      if (at == surfaces.end()) {
        const auto model = static_cast<std::size_t>(ground->object.model);
        at = surfaces.try_emplace(scatter.on, *models[model], world_from_models(draft, models, on))
                 .first;
      }
      surface = &at->second;
    }
    const RandomKey key{scatter.seed, stream_of(object.object.name), 0};
    for (std::uint64_t copy = 0; copy < scatter.count; ++copy) {
      const auto placed = draw_copy(scatter, surface, key, copy);
      if (!placed)
        return refusal(scatter.place,
                       fmt::format("no place for copy {} of {} in {} attempts", copy, scatter.count,
                                   kMaxAttempts),
                       "an area that the surface covers and keep_out_m leaves free");
      object.object.copies.push_back(*placed);
    }
  }
  return {};
}

}  // namespace neritic::scene
