// The picture of a single beam's echo over range, as on an oscilloscope. Pure; any thread.
#pragma once

#include <span>

#include "sonar/panel.hpp"

namespace neritic::sonar {

// intensity: [n_range] of the grid. RGB.
ImageU8 draw_trace(const BeamGrid& grid, std::span<const float> intensity,
                   const PanelOptions& options);

}  // namespace neritic::sonar
