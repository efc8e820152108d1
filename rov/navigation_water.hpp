// The doubt that navigation needs where the settings of a pressure sensor are not the water and the
// air of the scene: its file is written before anybody knows where the vehicle dives. Pure
// functions; any thread.
#pragma once

#include "rov/inertial_sensors.hpp"
#include "rov/navigation_model.hpp"

namespace neritic::rov {

// The depth that the sensor tells at a depth of still water, without noise: by its own density,
// gravity and pressure of the air. Metres.
double told_depth_m(const PressureSensor& sensor, const SensorWater& water, double depth_m);

// Widens what the model takes the errors of the depth for at first, their zero and their scale, by
// what the settings are off: their size, not their sign, so that navigation must still estimate
// them. The scale is the largest from the surface down to that depth. In layers a metre's weight
// changes with depth, where the filter has one scale for all: the zero then wanders as fast as a
// vehicle that rises or sinks makes it.
void allow_for_water(const SensorWater& water, double deepest_m, NavigationModel& model);

}  // namespace neritic::rov
