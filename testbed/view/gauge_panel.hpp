// Gauges of the vehicle that is flown by hand: depth, speed, the share of each thruster's limit,
// the tether's pull, the battery. Dear ImGui calls. Rendering thread.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hud/numbers.hpp"
#include "testbed/simulation/physics_world.hpp"
#include "testbed/view/panel_layout.hpp"

namespace neritic::testbed {

struct VehicleGauges {
  std::string name;
  double depth_m = 0.0, heading_rad = 0.0, speed_m_s = 0.0;
  std::vector<double> thrust;  // each thruster's share of its limit, -1 to 1
  std::vector<bool> failed;
  std::uint64_t tether_touching = 0;         // segments on something solid
  double tether_n = 0.0, tether_used = 0.0;  // pull; distance over its length. used 0: no tether
  struct Battery {
    double voltage_v = 0.0, charge = 0.0, left_s = 0.0;  // charge of 1; time at the power of now
  };
  std::optional<Battery> battery;
};
// The gauges of the vehicle with that number.
VehicleGauges gauges_of(const PhysicsWorld& world, const PhysicsState& state, std::size_t vehicle);

// "tether 12 N, 80 % of its length out, it touches"
std::string tether_words(const VehicleGauges& gauges, hud::Units units);
PanelWish gauges_wish(const VehicleGauges& gauges);
void draw_gauges(const VehicleGauges& gauges, const PanelRect& rect, hud::Units units, float scale);

}  // namespace neritic::testbed
