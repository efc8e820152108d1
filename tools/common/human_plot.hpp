// A diver's part of the plot of a dive: depth with its dangers, rates, times, tanks, pace, gas,
// heart, balance, risks. Pure functions; any thread.
#pragma once

#include "testbed/record/human_record.hpp"
#include "tools/common/plot_series.hpp"

namespace neritic::tools {
using namespace testbed;

// Heights of a panel, and of all six rows of them.
inline constexpr double kHumanPanel_px = 420.0, kHumanPanels_px = 6.0 * kHumanPanel_px;

// Of each diver, a line: east and north, or time and height over the surface.
std::vector<Series> human_paths(const PhysicsWorld& world, const std::vector<HumanRow>& rows);
std::vector<Series> human_heights(const PhysicsWorld& world, const std::vector<HumanRow>& rows);

// Twelve panels of a diver, the world's index-th, as wide as the canvas from top on; each has one
// unit. Who has no tank has no panel of tanks.
void draw_human_panels(sonar::Canvas& canvas, double width_px, double top_px,
                       const PhysicsHuman& human, std::size_t index,
                       const std::vector<HumanRow>& rows);

}  // namespace neritic::tools
