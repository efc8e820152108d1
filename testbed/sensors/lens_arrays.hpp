// A camera's arrays through its lens, made of a pinhole's. Pure functions; any thread.
#pragma once

#include <vector>

#include "engine/scene/camera_terms.hpp"
#include "testbed/sensors/frame_result.hpp"

namespace neritic::testbed {

// Where each pixel of a lens's picture lies in the pinhole's: pixels, centres at +0.5.
std::vector<glm::dvec2> lens_map(const scene::Lens& lens, const scene::LensView& view,
                                 std::uint32_t width, std::uint32_t height);

// Labels, instances and normals are the nearest texel's. Depth and motion lie between four texels
// of one surface (inverse depth is linear across a plane's picture), else they are the nearest's.
// Motion leads to where the lens shows the point in the next picture. out: its size, lens and
// intrinsics are set; it gets the arrays that source has.
void arrays_through_lens(const ViewImages& source, const scene::Lens& lens,
                         const scene::LensView& view, const std::vector<glm::dvec2>& map,
                         ViewImages& out);

}  // namespace neritic::testbed
