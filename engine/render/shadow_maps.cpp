#include "engine/render/shadow_maps.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/core/hash.hpp"
#include "engine/core/refusal.hpp"

namespace neritic::render {
namespace {

// So far away that rays over a square of 40 m differ by 0.5 degrees, the width of the sun's disk;
// floats still tell half a millimetre there.
constexpr double kSunAway_m = 5000.0;
// Things nearer to the sun than this, or further, throw no shadow.
constexpr double kCasters_m = 300.0;
// Half width of each square over that of the next.
constexpr double kCascadeStep = 1.0 / 3.0;
// The squares lie ahead of the camera, by this share of their half width.
constexpr double kAhead = 0.6;
// Steps in which a square moves, over its width.
constexpr std::uint32_t kStepsAcross = 16;

// Lamps see what is farther than their glass. A wider cone than this throws its outermost light
// without shadows.
constexpr double kLampNear_m = 0.08, kWidestLamp_rad = radians(75.0);

// From positions relative to the camera's origin to another view's clip space.
Mat4f clip_from(const ViewSet& camera, const ViewDesc& view) {
  Pose origin_from_view = view.world_from_view;
  origin_from_view.position_m -= camera.origin_m();
  return Mat4f(reversed_z_projection(view.tangents, view.near_m) *
               to_matrix(inverse(origin_from_view)));
}

}  // namespace

std::vector<ViewSet> sun_views(const ViewSet& camera, const scene::SunShadows& shadows,
                               const Vec3& to_sun) {
  // Axes as any view's: z towards the sun, x level.
  const Vec3 side = std::abs(to_sun.y) < 0.999 ? Vec3(0.0, 1.0, 0.0) : Vec3(0.0, 0.0, -1.0);
  const Vec3 x = glm::normalize(glm::cross(side, to_sun));
  const Vec3 y = glm::cross(to_sun, x);
  const Quat rotation = glm::normalize(glm::quat_cast(Mat3(x, y, to_sun)));
  Vec3 eye_m(0.0), ahead(0.0);
  for (const ViewDesc& view : camera.views) {
    eye_m += view.world_from_view.position_m / double(camera.views.size());
    ahead += view.world_from_view.rotation * Vec3(0.0, 0.0, -1.0);
  }
  if (glm::dot(ahead, ahead) > 0.0) ahead = glm::normalize(ahead);
  std::vector<ViewSet> out;
  for (std::uint32_t i = 0; i < shadows.cascades; ++i) {
    const double half_m =
        shadows.reach_m * std::pow(kCascadeStep, double(shadows.cascades - 1 - i));
    const double step_m = 2.0 * half_m / shadows.size * std::max(shadows.size / kStepsAcross, 1u);
    const Vec3 wanted_m = eye_m + ahead * (kAhead * half_m);
    const auto stepped = [&](const Vec3& axis) {
      return axis * (std::round(glm::dot(wanted_m, axis) / step_m) * step_m);
    };
    const Vec3 center_m = stepped(x) + stepped(y) + stepped(to_sun);
    ViewSet set;
    set.width = set.height = shadows.size;
    ViewDesc view;
    const double tangent = half_m / kSunAway_m;
    view.tangents = {-tangent, tangent, -tangent, tangent};
    view.near_m = kSunAway_m - kCasters_m;
    view.world_from_view = view.next_world_from_view = {center_m + to_sun * kSunAway_m, rotation};
    set.views = {view};
    out.push_back(std::move(set));
  }
  return out;
}

std::vector<ShadowMap> shadow_maps(const scene::Scene& scene, const GpuScene& gpu_scene,
                                   const FrameState& state, std::vector<ViewSet> views,
                                   DrawListOptions options) {
  options.hide_back_faces = true;
  std::vector<ShadowMap> maps;
  for (ViewSet& set : views) {
    ShadowMap& map = maps.emplace_back();
    map.layer = static_cast<std::uint32_t>(maps.size() - 1);
    map.views = std::move(set);
    map.draws = build_draw_list(scene, gpu_scene, state, map.views, options);
    map.draws.blended.clear();
  }
  return maps;
}

std::vector<std::uint8_t> moving_objects(const scene::Scene& scene) {
  std::vector<std::uint8_t> out;
  for (const scene::Object& object : scene.objects) {
    bool moves = object.clip >= 0 || object.flock;
    if (object.model >= 0) {
      const scene::Model& model = *scene.models[static_cast<std::size_t>(object.model)];
      for (const scene::Node& node : model.nodes) moves |= node.skin >= 0;
    }
    // With all that carries it.
    const scene::Object* at = &object;
    for (std::size_t steps = 0; at && steps <= scene.objects.size(); ++steps) {
      moves |=
          at->mount.track || at->mount.afloat || at->dynamics || at->human || !at->inputs.empty();
      const scene::Object* by = at->mount.object >= 0
                                    ? &scene.objects[static_cast<std::size_t>(at->mount.object)]
                                    : nullptr;
      moves |= by && at->mount.joint >= 0 && by->clip >= 0;
      at = by;
    }
    out.push_back(moves ? 1 : 0);
  }
  return out;
}

std::uint64_t still_hash(const FrameState& state, std::span<const std::uint8_t> moving) {
  Hash64 hash;
  for (std::size_t i = 0; i < moving.size(); ++i) {
    if (moving[i]) continue;
    hash.add(state.world_from_object[i]);
    hash.add_span(std::span<const Mat4>(state.poses[i].model_from_node));
    for (const auto& weights : state.poses[i].morph_weights)
      hash.add_span(std::span<const float>(weights));
  }
  return hash.value();
}

Result<std::vector<ViewSet>> lamp_views(const scene::Scene& scene, const FrameState& state) {
  std::vector<ViewSet> out;
  std::uint32_t size = 0;
  for (std::size_t i = 0; i < scene.lamps.size(); ++i) {
    const scene::Lamp& lamp = scene.lamps[i];
    if (!lamp.shadows) continue;
    ViewDesc view;
    const double tangent = std::tan(std::min(lamp.outer_cone_rad, kWidestLamp_rad) + 1e-3);
    view.tangents = {-tangent, tangent, -tangent, tangent};
    view.near_m = kLampNear_m;
    view.world_from_view = view.next_world_from_view = state.world_from_lamp[i];
    out.emplace_back().views = {view};
    size = std::max(size, lamp.shadow_size);
  }
  if (out.size() > shared::kMaxLampShadows)
    return refusal(fmt::format("{}: lamps with shadows", scene.path), fmt::format("{}", out.size()),
                   fmt::format("at most {}", shared::kMaxLampShadows));
  for (ViewSet& set : out) set.width = set.height = size;
  return out;
}

shared::LampShadows lamp_shadows(const scene::Scene& scene, const ViewSet& camera,
                                 const std::vector<ShadowMap>& maps) {
  shared::LampShadows out{};
  out.near_m = static_cast<float>(kLampNear_m);
  std::ranges::fill(out.layer, shared::kMaxLampShadows);
  for (std::uint32_t i = 0, layer = 0; i < scene.lamps.size(); ++i)
    if (scene.lamps[i].shadows) {
      out.layer[i] = layer;
      out.clip_from_origin[layer] = clip_from(camera, maps[layer].views.views.front());
      ++layer;
    }
  return out;
}

shared::VisibilityParams visibility_params(const scene::Scene& scene, const ViewSet& camera,
                                           const shared::Lighting& lighting,
                                           const std::vector<ViewSet>& cascades) {
  shared::VisibilityParams params{};
  params.to_sun = lighting.to_sun;
  params.origin_depth_m = lighting.origin_depth_m;
  // The disk's half-angle; waves of a light breeze turn the beam by a quarter of their slopes
  // ((n - 1) / n; Cox and Munk 1954: some 0.16 at 4 m/s).
  params.spread = scene.water ? 0.04f : 0.0047f;
  params.scattering_m = lighting.particle_scattering.y;
  params.sun_cosine = lighting.sun_cosine;
  if (scene.ambient) params.occlusion_m = static_cast<float>(scene.ambient->occlusion_m);
  for (std::size_t i = 0; i < cascades.size(); ++i) {
    const ViewSet& set = cascades[i];
    const ViewDesc& view = set.views.front();
    shared::Cascade& cascade = params.cascades[i];
    cascade.clip_from_origin = clip_from(camera, view);
    cascade.across = Vec3f(view.world_from_view.rotation * Vec3(1.0, 0.0, 0.0));
    cascade.along = Vec3f(view.world_from_view.rotation * Vec3(0.0, 1.0, 0.0));
    cascade.near_m = static_cast<float>(view.near_m);
    cascade.half_m = static_cast<float>(view.tangents.right * kSunAway_m);
  }
  return params;
}

}  // namespace neritic::render
