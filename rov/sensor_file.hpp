// A vehicle's sensors from its file: tables [imu], [dvl], [pressure], [compass], [altimeter],
// [usbl], each there only if named. One thread.
#pragma once

#include "engine/core/case_file.hpp"
#include "rov/sensor_set.hpp"

namespace neritic::rov {

// Faults are recorded in the field's file. gravity_m_s2: the vehicle's, which its sensors share
// unless their tables name another.
SensorSet read_sensors(const CaseField& vehicle, double gravity_m_s2);

}  // namespace neritic::rov
