#include "diver/ascent_gas.hpp"

#include <algorithm>

namespace neritic::diver {
namespace {

static_assert(kToldGases >= kMaxTanks);

// Litres at 1 bar that a tank gives in full breaths up to the surface.
double litres_there(const Body& body, const TankState& tanks, std::size_t tank) {
  const TankPlace& place = body.tanks[tank];
  const double kept = moles_in(place.mix, place.water_volume_m3, body.surface_pa + kWeakTank_pa);
  return 1e-2 * kGasConstant * kTankTemperature_k * std::max(tanks.moles[tank] - kept, 0.0);
}

}  // namespace

AscentGas ascent_gas(const DiveComputer& computer, const DiveComputerState& state, const Body& body,
                     const TankState& tanks, double litres_a_minute) {
  const auto& gases = computer.settings().gases;
  const std::size_t count = std::min(gases.size(), body.tank_count);
  std::array<double, kMaxTanks> ambient_pa{};
  for (std::size_t i = 0; i < count; ++i)
    ambient_pa[i] = pressure_at(body, gases[i].switch_depth_m);
  AscentGas out;
  out.too_small = empty_tanks(body, tanks, std::span(ambient_pa).first(count));
  const auto short_of = [&](std::size_t i) {
    return litres_a_minute * out.view.to_surface_bar_min[i] > litres_there(body, tanks, i);
  };
  const std::size_t breathed = state.last.gas;
  for (std::size_t round = 0; round <= count; ++round) {
    out.view = computer.view(state, out.too_small);
    std::uint64_t more = 0;
    for (std::size_t i = 0; i < count; ++i)
      if (i != breathed && (out.too_small >> i & 1u) == 0 && short_of(i)) more |= 1u << i;
    if (more == 0) break;
    out.too_small |= more;
  }
  if (breathed >= count) return out;
  out.needed_l = litres_a_minute * out.view.to_surface_bar_min[breathed];
  out.there_l = litres_there(body, tanks, breathed);
  if (!out.enough()) out.too_small |= std::uint64_t{1} << breathed;
  return out;
}

}  // namespace neritic::diver
