// Each sensor's reading as a measurement of the navigation's errors, which the filter is
// corrected by (navigation_filter.hpp). Derivatives are exact to first order in the errors. NED and
// body axes. Pure functions; any thread.
#pragma once

#include "rov/navigation_model.hpp"

namespace neritic::rov {

// The specific force of a vehicle that hardly accelerates is gravity's: levels it (Groves 2013,
// section 5.6.2). Uses the state's own inertial reading.
Measurement level_measurement(const NavigationModel& model, const NavigationState& state);

// The speed of the DVL along beam i.
Measurement beam_measurement(const NavigationModel& model, const NavigationState& state,
                             std::size_t beam, double speed_m_s);
Measurement depth_measurement(const NavigationModel& model, const NavigationState& state,
                              double depth_m);
// The compass's deviation is A + B sin(heading) + C cos(heading), as Archibald Smith's (Admiralty
// Manual 1862), without the terms of soft iron.
Measurement heading_measurement(const NavigationModel& model, const NavigationState& state,
                                double heading_rad);
// Whether a heading means anything: the bow is less than 70 degrees off level.
bool has_heading(const NavigationState& state);
// A fix of the beacon as it was age_s ago.
Measurement fix_measurement(const NavigationModel& model, const NavigationState& state,
                            const UsblReading& reading, double age_s);

}  // namespace neritic::rov
