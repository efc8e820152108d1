// The data of a diver's instruments and an operator's console, read off the simulation. Pure
// functions; any thread.
#pragma once

#include <string>
#include <vector>

#include "engine/scene/motion.hpp"
#include "hud/shown.hpp"
#include "testbed/devices/device_source.hpp"
#include "testbed/simulation/physics_world.hpp"

namespace neritic::testbed {

// Precondition: diver is the number of one of the world's divers.
hud::DiveData instrument_data(const PhysicsWorld& world, std::size_t diver,
                              const sim::Snapshot<PhysicsState>& snapshot);

// The groups of the diver's inputs that a live source has or had: "heart", "live from strap".
std::vector<hud::StreamHealth> stream_health(const HumanPhysics& diver,
                                             const std::vector<std::string>& sources);

// Adds each device's link and clock to the notes of the groups that it feeds: "suit 480/s, 2.0 %
// lost, +12 ppm". streams: of stream_health, in its order.
void add_links(const HumanPhysics& diver, const std::vector<DeviceHealth>& devices,
               const std::vector<std::string>& sources, std::vector<hud::StreamHealth>& streams);

// The heading of a diver in any attitude, from north towards east: ahead is where the head points
// while the diver swims, and where the belly points while the diver stands. A body that lies on its
// back or on its head is given a heading too.
double diver_heading_rad(const Quat& ned_from_body);

// A diver's depth and heading as the diver's instruments show them: metres of EN 13319 at the depth
// gauge, and diver_heading_rad.
struct DiverGauge {
  double depth_m = 0.0, heading_rad = 0.0;
};
DiverGauge gauge_of(const PhysicsHuman& human, const HumanPhysics& state);

// The hand in a state: origin at the wrist, axes of hud::Lock::kWrist, as those of a tracked one.
Pose world_from_wrist(const PhysicsHuman& human, const HumanPhysics& state, bool right = false);
// The left one as a picture of that time draws it: by the motion that the picture is drawn with,
// which may be predicted from an older state. motion: of the scene that human is of.
Pose world_from_drawn_wrist(const PhysicsHuman& human, const scene::MotionSource& motion,
                            double time_s);

}  // namespace neritic::testbed
