// What the sun and lamps see: views of depth alone, drawn before the picture. Plain data made on
// the CPU, in double.
#pragma once

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
  DrawList draws;  // opaque surfaces only: glass throws no shadow
};

// Sees what to_sun (unit) shines on, out of 5 km: squares round what the camera looks at, each
// three times as narrow as the next. They move with the camera in whole texels, so that edges do
// not crawl.
std::vector<ViewSet> sun_views(const ViewSet& camera, const scene::SunShadows& shadows,
                               const Vec3& to_sun);

// Draw lists of these views.
std::vector<ShadowMap> shadow_maps(const scene::Scene& scene, const GpuScene& gpu_scene,
                                   const FrameState& state, std::vector<ViewSet> views);

// What each lamp of the scene with shadows sees, in the order of the lamps. kBadInput: more than
// kMaxLampShadows.
Result<std::vector<ViewSet>> lamp_views(const scene::Scene& scene, const FrameState& state);

// The lamps' maps as a camera's shading reads them.
shared::LampShadows lamp_shadows(const scene::Scene& scene, const ViewSet& camera,
                                 const std::vector<ShadowMap>& maps);

// Parameters of the visibility pass for a camera's view set: terms of the scene's sun and ambient.
shared::VisibilityParams visibility_params(const scene::Scene& scene, const ViewSet& camera,
                                           const shared::Lighting& lighting,
                                           const std::vector<ShadowMap>& cascades);

}  // namespace neritic::render
