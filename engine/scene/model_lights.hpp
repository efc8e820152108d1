// The lights that a scene's models bring (KHR_lights_punctual): which of them shine, decided once
// after loading. Where they are is a matter of the frame (render::evaluate_frame), since objects
// and nodes move. Pure; any thread.
#pragma once

#include <cstddef>

#include "engine/scene/scene.hpp"

namespace neritic::scene {

// Lamps and models' lights that a scene may have at once.
inline constexpr std::size_t kMaxLamps = 16;

const Light& light_of(const Scene& scene, const ModelLight& light);

// Fills scene.model_lights: the brightest point and spot lights that the scene's own lamps leave
// room for, and, where the scene names no sun, the brightest directional one in its place. A line
// of scene.notes says what stays dark.
void choose_model_lights(Scene& scene);

// Illuminance in lux that they give at a point of the world at time 0, cones and shadows left out;
// no lamp is counted as nearer than nearest_m.
double model_light_lx(const Scene& scene, const Vec3& point_m, double nearest_m);

}  // namespace neritic::scene
