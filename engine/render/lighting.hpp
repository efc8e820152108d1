// Sun, lamps and water of a scene as the shaders see them, relative to a view set's origin.
#pragma once

#include <string>

#include "engine/core/result.hpp"
#include "engine/render/frame_state.hpp"
#include "engine/scene/scene.hpp"
#include "shared/lighting.h"

namespace neritic::render {

// Illuminance of a clear day with the sun in the zenith, lux (rounded; direct sunlight 80 to 100
// klx, Schlyter, "Radiometry and photometry in astronomy").
inline constexpr double kClearDay_lx = 100000.0;
// Share of it that comes straight from the sun (the rest is sky; clear days have 0.8 to 0.9).
inline constexpr double kSunShare = 0.85;

// kBadInput for an unknown water type or too many lamps. exposure: of the camera that looks. Lamps
// and models' lights shine from where they are in the state, at its time. exposed_s: how long,
// round that time, a strobe's flashes add to the picture; 0: it burns at that instant or does not.
Result<shared::Lighting> make_lighting(const scene::Scene& scene, const FrameState& state,
                                       const Vec3& origin_m, const scene::Exposure& exposure,
                                       bool has_emission, double exposed_s = 0.0);

// Unit, towards the scene's sun above the surface.
Vec3 to_sun_in_air(const scene::Sun& sun);

// The terms that shading computes, for the frame graph's dump: "sun, water, scattering, 2 lamps".
std::string names_of_terms(const shared::Lighting& lighting);

}  // namespace neritic::render
