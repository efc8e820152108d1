#include "diver/jacket.hpp"

#include <algorithm>
#include <cmath>

namespace neritic::diver {
namespace {

constexpr double kJacketHeat = kGasConstant * kTankTemperature_k;  // R T: the water holds it there

// Height of a cap of the unit sphere that holds a share of it: share = h^2 (3 - h) / 4.
double cap_height(double share) {
  if (share <= 0.0) return 0.0;
  if (share >= 1.0) return 2.0;
  // h^3 - 3 h^2 + 4 share = 0 with h = 1 + x: x^3 - 3 x + (4 share - 2) = 0, by angles.
  return 1.0 + 2.0 * std::cos((std::acos(1.0 - 2.0 * share) - 2.0 * kPi) / 3.0);
}

// Distance of the cap's centroid from the sphere's middle.
double cap_centroid(double height) {
  return 0.75 * (2.0 - height) * (2.0 - height) / (3.0 - height);
}

// How far up the bladder reaches from its middle; and where its highest point is.
double half_height(const Jacket& jacket, const Vec3& up) {
  return glm::length(jacket.half_axes_m * up);
}

double ambient_above(const Body& body, const ThoraxPlace& place, double above_m) {
  return pressure_at(body, place.depth_m - above_m);
}

// Leaves moles less what a valve lets out, which is slower the less is left: so it never goes below
// 0 (or below what keeps the valve shut), however long the step.
void let_out(double& moles, double rate_moles_s, double dt_s, double floor_moles = 0.0) {
  const double over = moles - floor_moles;
  if (over > 0.0 && rate_moles_s > 0.0)
    moles = floor_moles + over * std::exp(-rate_moles_s * dt_s / over);
}

// Out of a valve at a place of the bladder, gas that stands that high above it.
double valve_flow(const Body& body, const JacketGas& gas, double area_m2, double mouth_m,
                  const ThoraxPlace& place) {
  return orifice_moles_s(kAir, area_m2, gas.pressure_pa, ambient_above(body, place, mouth_m));
}

// Height of the higher one of both above the thorax's origin.
double dump_height(const Jacket& jacket, const ThoraxPlace& place) {
  return std::max(glm::dot(place.up, jacket.dump_m), glm::dot(place.up, jacket.relief_at_m));
}

}  // namespace

JacketGas jacket_gas(const Body& body, double moles, const ThoraxPlace& place) {
  const Jacket& jacket = body.jacket;
  JacketGas gas;
  gas.centre_m = jacket.centre_m;
  if (!(jacket.capacity_m3 > 0.0)) return gas;
  const double middle_m = glm::dot(place.up, jacket.centre_m);
  const double reach_m = half_height(jacket, place.up);
  // The pressure is the water's at the lower side, which depends on the volume: two rounds are good
  // to a hundredth of a per cent.
  double height = 1.0;
  for (int i = 0; i < 2; ++i) {
    gas.bottom_m = middle_m + reach_m * (1.0 - height);
    gas.ambient_pa = ambient_above(body, place, gas.bottom_m);
    gas.volume_m3 = std::min(jacket.capacity_m3, moles * kJacketHeat / gas.ambient_pa);
    height = cap_height(gas.volume_m3 / jacket.capacity_m3);
  }
  gas.bottom_m = middle_m + reach_m * (1.0 - height);
  gas.pressure_pa = gas.volume_m3 < jacket.capacity_m3
                        ? gas.ambient_pa
                        : std::max(gas.ambient_pa, moles * kJacketHeat / jacket.capacity_m3);
  if (reach_m > 0.0) {
    Vec3 shift =
        (cap_centroid(height) / reach_m) * (jacket.half_axes_m * jacket.half_axes_m * place.up);
    shift.y *= jacket.sideways;
    gas.centre_m += shift;
  }
  return gas;
}

bool gas_at_dump(const Body& body, double moles, const ThoraxPlace& place) {
  return moles > 0.0 && jacket_gas(body, moles, place).bottom_m < dump_height(body.jacket, place);
}

void step_jacket(const Body& body, double& moles, TankState& tanks, std::uint64_t buttons,
                 const ThoraxPlace& place, double dt_s) {
  const Jacket& jacket = body.jacket;
  if (!(jacket.capacity_m3 > 0.0)) return;
  if ((buttons & kInflate) && !(buttons & kDump)) {
    const double back_pa = jacket_gas(body, moles, place).pressure_pa;
    moles += flow_from(body, tanks, 0, jacket.inflator_m2, back_pa, dt_s);
  }
  if (buttons & kDeflate) {
    const JacketGas gas = jacket_gas(body, moles, place);
    // Gas comes to the hose where it reaches down to its root; the mouth is held above that.
    const double root_m = glm::dot(place.up, jacket.hose_root_m);
    if (gas.bottom_m < root_m)
      let_out(moles, valve_flow(body, gas, jacket.deflator_m2, root_m + jacket.hose_m, place),
              dt_s);
  }
  if (buttons & kDump) {
    const JacketGas gas = jacket_gas(body, moles, place);
    const double at_m = dump_height(jacket, place);
    if (gas.bottom_m < at_m)
      let_out(moles, valve_flow(body, gas, jacket.dump_m2, at_m, place), dt_s);
  }
  const JacketGas gas = jacket_gas(body, moles, place);
  const double at_m = glm::dot(place.up, jacket.relief_at_m);
  const double shut_pa = ambient_above(body, place, at_m) + jacket.relief_pa;
  if (gas.pressure_pa > shut_pa) {
    // Wide open a third of its pressure further.
    const double open = std::min(1.0, (gas.pressure_pa - shut_pa) / (jacket.relief_pa / 3.0));
    let_out(moles, valve_flow(body, gas, open * jacket.relief_m2, at_m, place), dt_s,
            shut_pa * jacket.capacity_m3 / kJacketHeat);
  }
}

double jacket_moles(const Body& body, double volume_m3, const ThoraxPlace& place) {
  const Jacket& jacket = body.jacket;
  if (!(jacket.capacity_m3 > 0.0)) return 0.0;
  const double volume = std::clamp(volume_m3, 0.0, jacket.capacity_m3);
  const double height = cap_height(volume / jacket.capacity_m3);
  const double bottom_m =
      glm::dot(place.up, jacket.centre_m) + half_height(jacket, place.up) * (1.0 - height);
  return volume * ambient_above(body, place, bottom_m) / kJacketHeat;
}

}  // namespace neritic::diver
