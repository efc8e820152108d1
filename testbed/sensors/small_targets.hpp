// Targets smaller than a sonar's cells: how large they are drawn at least, and what a sample of
// them then counts, so that each is heard in every ping with its own energy. Pure functions; any
// thread.
#pragma once

#include <vector>

#include "engine/render/draw_list.hpp"
#include "shared/sonar.h"
#include "sonar/head.hpp"

namespace neritic::testbed {

// The extent at which a target is met by some ninety samples, no matter where it lies: a third of a
// beam wide at most (but a column) and a quarter of the aperture high. pixels_per_cell: of the
// G-buffer, linear.
render::LeastDrawn least_drawn(const sonar::Head& head, const scene::Sonar& sonar,
                               double pixels_per_cell);

// The least of the largest extents of objects and copies, m; 0: there is no such object.
double least_object_m(const scene::Scene& scene);

// Strengths by instance label (empty: all are 1) with those of what is drawn larger: negative, and
// less by as much as it is larger. solid_angle: sonar::counts_solid_angle; else cells count alike,
// and a thing has fewer of them where it is drawn nearer to the level.
std::vector<float> sample_strengths(std::vector<float> strengths,
                                    const std::vector<render::DrawnLarger>& larger,
                                    bool solid_angle);

// Where the things are that a view draws larger, by ascending labels. direct: of a ghost's view,
// what the sonar's own view draws larger.
std::vector<shared::SonarDrawnLarger> places_of(
    const std::vector<render::DrawnLarger>& here,
    const std::vector<render::DrawnLarger>& direct = {});

}  // namespace neritic::testbed
