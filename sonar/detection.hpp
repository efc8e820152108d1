// How a sonar's settings tell a return from noise, the same for a ping of a scene's track and for
// one made from images: the floor of each range row, and what bottom detection, echo trace and
// side-scan make of it. Pure functions of plain values; any thread.
#pragma once

#include <span>
#include <vector>

#include "engine/scene/scene.hpp"
#include "sonar/bottom_detection.hpp"
#include "sonar/echo_trace.hpp"
#include "sonar/ping.hpp"
#include "sonar/sidescan.hpp"

namespace neritic::sonar {

// Mean power of the noise in each range row as it leaves the receiver; empty where none is named.
std::vector<float> noise_by_row(const Ping& ping);

// The power that a return must exceed in each range row: the detection's floor_db above the noise's
// mean, or the level that noise alone (exponentially distributed) exceeds in one of ten million
// bins: a constant false alarm rate at any gain. Empty without noise.
std::vector<float> detection_floor(const scene::SonarDetection& detection,
                                   std::span<const float> noise_by_row);

// intensity [range][beams] of the grid. floor: of detection_floor, as below.
std::vector<BottomDetection> detect_bottom(const BeamGrid& grid, std::span<const float> intensity,
                                           const scene::SonarDetection& detection,
                                           std::span<const float> floor);
EchoTraceOptions echo_trace_options(const BeamGrid& grid, const scene::SonarTerms& terms,
                                    std::vector<float> floor);
SidescanOptions sidescan_options(const BeamGrid& grid, const scene::SonarTerms& terms,
                                 std::vector<float> floor);

}  // namespace neritic::sonar
