// The light of a view set's picture: shadows of sun and lamps, caustics, shafts, ambient occlusion,
// each declared only if the scene names it. Private to testbed/sensors; rendering thread.
#pragma once

#include "testbed/sensors/view_sensor.hpp"

namespace neritic::testbed {

// Declares the passes that find what stands in the light's way, and sets the terms that are there.
Result<render::LightImages> declare_light(const FrameParts& frame, const std::string& prefix,
                                          const render::GBuffer& g, const render::ViewSet& views,
                                          const render::DrawList& draws,
                                          const scene::PictureDetail& detail, ViewsWork& work,
                                          shared::Lighting& lighting);
// Pixels a side that share a shadow; 1 where the scene asks for full resolution.
std::uint32_t visibility_step(const scene::Scene& scene, const scene::PictureDetail& detail);

}  // namespace neritic::testbed
