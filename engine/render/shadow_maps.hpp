// The views of sun and lamps: views of depth alone, drawn before the picture. Plain data made on
// the CPU, in double.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/core/result.hpp"
#include "engine/render/draw_list.hpp"
#include "engine/scene/scene.hpp"
#include "shared/lighting.h"
#include "shared/visibility.h"

namespace neritic::render {

// One layer of a map; a view set of one view.
struct ShadowMap {
  ViewSet views;
  DrawList draws;           // opaque surfaces only: glass throws no shadow
  std::uint32_t layer = 0;  // of the image
};

// Views from 5 km away along to_sun (unit): squares round what the camera looks at, each
// three times as narrow as the next. They follow the camera in steps of an eighth of their half
// width and of whole texels, so that edges do not crawl, and a map is drawn anew only at a step.
std::vector<ViewSet> sun_views(const ViewSet& camera, const scene::SunShadows& shadows,
                               const Vec3& to_sun);

// Draw lists of these views, a layer each. options: hide_back_faces is set anyway.
std::vector<ShadowMap> shadow_maps(const scene::Scene& scene, const GpuScene& gpu_scene,
                                   const FrameState& state, std::vector<ViewSet> views,
                                   DrawListOptions options = {});

// Flags by object: 1 where something of the scene may move or deform it.
std::vector<std::uint8_t> moving_objects(const scene::Scene& scene);
// Hash of where the others are: differs if one of them has moved after all (a replay shows its
// motion in another scene).
std::uint64_t still_hash(const FrameState& state, std::span<const std::uint8_t> moving);

// The views of each lamp that casts shadows, in the order of the lamps. kBadInput: more than
// kMaxLampShadows.
Result<std::vector<ViewSet>> lamp_views(const scene::Scene& scene, const FrameState& state);

// The lamps' maps as a camera's shading reads them.
shared::LampShadows lamp_shadows(const scene::Scene& scene, const ViewSet& camera,
                                 const std::vector<ShadowMap>& maps);

// Parameters of the visibility pass for a camera's view set: terms of the scene's sun and ambient.
shared::VisibilityParams visibility_params(const scene::Scene& scene, const ViewSet& camera,
                                           const shared::Lighting& lighting,
                                           const std::vector<ViewSet>& cascades);

}  // namespace neritic::render
