// Oxygen exposure of a diver: the share of the central nervous system's limit (CNS) and the lungs'
// dose (OTU), and the limits by gas and depth that divers plan with. Pure functions over plain
// values; any thread. Pressures in bar, times in minutes.
#pragma once

#include "diver/deco_environment.hpp"
#include "diver/gas_mix.hpp"

namespace neritic::diver {

// Longest single exposure (NOAA Diving Manual, 4th ed. 2001, table 15-1: 720 min at 0.6 bar to 45
// at 1.6; 900 at 0.5 by the same manual's slope), linear between. Infinite up to 0.5. No limit is
// published above 1.6: the line falls on to zero at 1.7, but not below a minute, as a warning
// rather than a figure.
double cns_limit_min(double po2_bar);

struct OxygenExposure {
  double cns_percent = 0.0, otu = 0.0;

  static void fields(auto&& field, auto& self) {
    field("cns_percent", self.cns_percent);
    field("otu", self.otu);
  }
};

inline constexpr double kCnsFrom_bar = 0.5;       // as E. C. Baker and most programs count
inline constexpr double kCnsFromTable_bar = 0.6;  // where NOAA's printed table begins
inline constexpr double kCnsToTable_bar = 1.6;    // and ends

// The exposure of minutes at a partial pressure that changes linearly, in closed form: CNS 100 /
// limit, from cns_from_bar on; OTU ((pO2 - 0.5) / 0.5)^(5/6) a minute above 0.5 (J. M. Clark and C.
// J. Lambertsen 1971; R. W. Hamilton 1989).
OxygenExposure oxygen_exposure(double from_po2_bar, double to_po2_bar, double minutes,
                               double cns_from_bar = kCnsFrom_bar);

// The CNS share that remains after minutes without exposure: halves in 90 (Hamilton 1989).
double cns_after(double cns_percent, double minutes);
// Exposure after an addition, surface_min of which passed at the surface: there the CNS share
// declines, unless some is added (on oxygen). Planner and dive computer both use it.
OxygenExposure exposure_after(const OxygenExposure& before, const OxygenExposure& added,
                              double surface_min);

// Deepest for a partial pressure of oxygen.
double max_operating_depth_m(const GasMix& mix, double po2_bar, const DecoEnvironment& where);
// Default switch depth of a deco gas: the deepest multiple of 3 m (10 m a bar) with at most 1.6
// bar of oxygen.
double usual_switch_depth_m(const GasMix& mix);
// Equivalent narcotic depth on air where oxygen narcotises as nitrogen does.
double narcotic_depth_m(const GasMix& mix, double depth_m, const DecoEnvironment& where);
// Depth on air with as much nitrogen: the equivalent air depth of nitrox, and the narcotic depth
// where nitrogen alone narcotises.
double air_depth_m(const GasMix& mix, double depth_m, const DecoEnvironment& where);

// Gas density, g/L, from 1.429, 1.2505, 0.179 of oxygen, nitrogen, helium a bar (theirs at 0 C), as
// the limits are given (G. Anthony, S. J. Mitchell 2016): above 5.2 breathing becomes hard, 6.2 is
// the most.
double gas_density_g_l(const GasMix& mix, double pressure_bar);
inline constexpr double kAdvisedDensity_g_l = 5.2, kMostDensity_g_l = 6.2;

}  // namespace neritic::diver
