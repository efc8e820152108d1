// Light shafts of the renderer against their integral along each sight by brute force, in double.
#pragma once

#include "engine/gpu/device.hpp"
#include "tools/tradeoff/optics_tradeoff.hpp"

namespace neritic::tools {

// Sights through type IB from 3 m under waves, each by these samples: the root mean square of the
// ratio's error, after the blur that joins 16 pixels; ms a megapixel of the picture. The net of
// light is the device's (its own error is that of "caustics").
Result<OpticsPoint> shaft_point(gpu::Device& device, std::uint32_t samples, bool quick);

}  // namespace neritic::tools
