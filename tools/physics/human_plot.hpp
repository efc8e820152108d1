// A diver's part of the plot of a dive: pace, gas, decompression, breath. Pure functions; any
// thread.
#pragma once

#include "tools/physics/human_record.hpp"
#include "tools/physics/plot_series.hpp"

namespace neritic::tools {

// Height of the panels.
inline constexpr double kHumanPanels_px = 1560.0;

// Of each diver, a line: east and north, or time and height over the surface.
std::vector<Series> human_paths(const PhysicsWorld& world, const std::vector<HumanRow>& rows);
std::vector<Series> human_heights(const PhysicsWorld& world, const std::vector<HumanRow>& rows);

// Six panels of the first diver, as wide as the canvas from top on.
void draw_human_panels(sonar::Canvas& canvas, double width_px, double top_px,
                       const PhysicsWorld& world, const std::vector<HumanRow>& rows);

}  // namespace neritic::tools
