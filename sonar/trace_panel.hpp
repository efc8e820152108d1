// A single beam's echo over range, as an oscilloscope would show it. For people only.
#pragma once

#include <span>

#include "sonar/panel.hpp"

namespace neritic::sonar {

// intensity: [n_range] of the grid. RGB.
ImageU8 draw_trace(const BeamGrid& grid, std::span<const float> intensity,
                   const PanelOptions& options);

}  // namespace neritic::sonar
