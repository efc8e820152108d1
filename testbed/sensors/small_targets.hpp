// Targets smaller than a sonar's cells: how large they are drawn at least, and what a sample of
// them then counts, so that each is heard in every ping with its own energy. Pure functions; any
// thread.
#pragma once

#include <span>
#include <vector>

#include "engine/render/draw_list.hpp"
#include "sonar/head.hpp"

namespace neritic::testbed {

// The extent at which a target is met by some ninety samples, no matter where it lies: a third of a
// beam wide at most (but a column) and a quarter of the aperture high. pixels_per_cell: of the
// G-buffer, linear.
render::LeastDrawn least_drawn(const sonar::Head& head, const scene::Sonar& sonar,
                               double pixels_per_cell);

// The least of the largest extents of objects and copies, m; 0: there is no such object.
double least_object_m(const scene::Scene& scene);

// Strengths by instance label (empty: all are 1) with those of what is drawn larger: negative, less
// by as much as it is larger, and weighted as where it is, not as where it is drawn. weights: of
// the head's samples, [n_elevation][n_azimuth]; empty: all are 1.
std::vector<float> sample_strengths(std::vector<float> strengths,
                                    const std::vector<render::DrawnLarger>& larger,
                                    const sonar::BeamGrid& samples, std::span<const float> weights);

}  // namespace neritic::testbed
