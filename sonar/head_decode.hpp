// A head's gather at the host, by beams. Pure functions; any thread.
#pragma once

#include <span>
#include <vector>

#include "shared/sonar_echo.h"
#include "sonar/head.hpp"
#include "sonar/label_energy.hpp"
#include "sonar/ping.hpp"

namespace neritic::sonar {

// Whether some bin's strongest return is of a thing without a class.
bool any_unclassed(std::span<const std::uint32_t> keys);

// keys: [n_range][columns of head.samples], or empty. Class of each bin's strongest return
// [n_range][beams]: that of the beam's own columns, its margin's not counted. 0: nothing.
std::vector<std::uint16_t> beam_labels(const Head& head, std::span<const std::uint32_t> keys);

// The records of the direct gather and of each mirror's, [n_elevation][columns], by energy: after
// the beam pattern and the pulse where the head has them.
LabelImage beam_energies(const Head& head, const Ping& ping,
                         const std::vector<std::span<const shared::SonarRecord>>& layers);

}  // namespace neritic::sonar
