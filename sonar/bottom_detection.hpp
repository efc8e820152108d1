// Where each beam of a ping meets the bottom: one detection a beam at most. The methods are those
// of multibeam echo sounders (Lurton, An Introduction to Underwater Acoustics, 2nd ed. 2010,
// section 8.3.4): the maximum of amplitude where the echo is short, the echo's centre of gravity
// where an oblique beam spreads it over many bins. A beam is taken at elevation 0 of the fan. Pure
// functions in double; any thread.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/core/math.hpp"
#include "sonar/beam_grid.hpp"

namespace neritic::sonar {

enum class DetectionMethod : std::uint8_t { kAmplitude, kCentreOfGravity };

struct BottomDetection {
  std::uint32_t beam = 0;
  double range_m = 0.0;
  float intensity = 0.0f;  // of the strongest bin
  DetectionMethod method = DetectionMethod::kAmplitude;
  std::uint32_t echo_bins = 0;  // length of the echo
  float quality = 0.0f;         // 0 to 1: the echo's part in all that the beam heard
};

// The echo is the run of bins around the beam's strongest that reach the threshold; up to
// max_gap_bins that do not may lie inside it (speckle). Echoes of at most amplitude_bins are
// located at their maximum, longer ones at their centre of gravity, to which the bins on either
// side of the run count as well since the echo fills them in part.
struct BottomDetectionOptions {
  double relative_threshold = 0.2;   // of the beam's strongest bin, 0 to 1
  double floor = 0.0;                // a beam whose strongest bin is not above it has no detection
  std::uint32_t amplitude_bins = 3;  // a plateau of more has its maximum anywhere
  std::uint32_t max_gap_bins = 2;
  double least_quality = 0.0;  // an echo that is less of all its beam heard is no detection
};

// kBadInput that names the option.
Status validate(const BottomDetectionOptions& options);

// intensity: [range][azimuth] of the grid, row 0 nearest, linear (not decibels); what is not finite
// or negative counts as silence. CHECKs the size. In order of beams; a beam without an echo has no
// entry.
std::vector<BottomDetection> detect_bottom(const BeamGrid& grid, std::span<const float> intensity,
                                           const BottomDetectionOptions& options = {});

// The detection in sonar axes.
Vec3 detection_point(const BeamGrid& grid, const BottomDetection& detection);

// The class of what is strongest nearest to the detection within its echo, of an image's labels
// [range][azimuth] (CHECKed); 0 where none of it has one.
std::uint16_t detected_class(const BeamGrid& grid, std::span<const std::uint16_t> labels,
                             const BottomDetection& detection);

// Those whose beam points within half_angle_rad of straight down in the world.
std::vector<BottomDetection> nadir_detections(const BeamGrid& grid,
                                              std::span<const BottomDetection> detections,
                                              const Pose& world_from_sonar, double half_angle_rad);

// Where between the bins a maximum lies, -0.5 to 0.5, from its value and its neighbours'. A
// parabola where both neighbours reach side_level of it (a resolved peak), else the centre of
// gravity of the three (an echo that fills parts of two bins). All >= 0, at > 0.
double sub_bin_offset(double before, double at, double after, double side_level = 0.2);

}  // namespace neritic::sonar
