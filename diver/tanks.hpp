// Gas that is left and how it leaves: tanks, regulator. Pure functions; any thread.
#pragma once

#include <span>

#include "diver/body.hpp"
#include "diver/real_gas.hpp"

namespace neritic::diver {

struct TankState {
  std::array<double, kMaxTanks> moles{};

  static void fields(auto&& field, auto& self) { field("moles", self.moles); }
};

// The tanks at their start pressures.
TankState full_tanks(const Body& body);

double tank_pressure(const Body& body, const TankState& tanks, std::size_t tank);

// A first stage holds its hose so far over ambient, while the tank has it.
inline constexpr double kHosePressure_pa = 9.5e5;
// A tank that is less than this over ambient gives no full breath.
inline constexpr double kWeakTank_pa = 5e5;

// Takes up to wanted moles by way of a regulator's demand valve within dt_s, and returns what came:
// none where the tank is at ambient pressure, less than a hard breath where it is near.
double breathe_from(const Body& body, TankState& tanks, std::size_t tank, double wanted_moles,
                    double ambient_pa, double dt_s);
// A regulator's demand valve on one tank that has moles; takes what comes off them.
double breathe_tank(const TankPlace& place, double& moles, double wanted_moles, double ambient_pa,
                    double dt_s);
// Another diver's tank, breathed from by the second regulator on it.
struct BorrowedTank {
  TankPlace place;
  double moles = 0.0;  // in it
  double taken_moles = 0.0;
};
// The same by way of an opening of an effective area behind the first stage, into back_pa.
double flow_from(const Body& body, TankState& tanks, std::size_t tank, double area_m2,
                 double back_pa, double dt_s);

// Bits of tanks whose regulator gives no full breath at that depth's pressure, one a tank.
std::uint64_t empty_tanks(const Body& body, const TankState& tanks,
                          std::span<const double> ambient_pa);

// Moles a second through an opening, from one pressure into a lower one; choked where the ratio
// says so (ideal gas of two atoms; Shapiro 1953, ch. 4).
double orifice_moles_s(const GasMix& mix, double area_m2, double from_pa, double to_pa);

}  // namespace neritic::diver
