#include "diver/oxygen_exposure.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace neritic::diver {
namespace {

struct LimitPoint {
  double po2_bar, minutes;
};
constexpr LimitPoint kLimits[] = {{0.5, 900}, {0.6, 720}, {0.7, 570}, {0.8, 450}, {0.9, 360},
                                  {1.0, 300}, {1.1, 240}, {1.2, 210}, {1.3, 180}, {1.4, 150},
                                  {1.5, 120}, {1.6, 45},  {1.7, 0}};
// The last line ends where its limit is the least, for good.
constexpr double kLeastLimit_min = 1.0;
constexpr double kLeastLimit_bar = 1.6 + 0.1 * (45.0 - kLeastLimit_min) / 45.0;
constexpr double kOtuFrom_bar = 0.5;

double on_line(const LimitPoint& a, const LimitPoint& b, double po2_bar) {
  return a.minutes + (b.minutes - a.minutes) * (po2_bar - a.po2_bar) / (b.po2_bar - a.po2_bar);
}

// Integral of d pO2 / limit from one pressure to a higher one within a line of the table.
double over_line(const LimitPoint& a, const LimitPoint& b, double from_bar, double to_bar) {
  const double slope = (b.minutes - a.minutes) / (b.po2_bar - a.po2_bar);
  return std::log(on_line(a, b, to_bar) / on_line(a, b, from_bar)) / slope;
}

// Integral of d pO2 / limit, from <= to.
double over_table(double from_bar, double to_bar) {
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < std::size(kLimits); ++i) {
    const double low = std::max(from_bar, kLimits[i].po2_bar);
    const double high = std::min({to_bar, kLimits[i + 1].po2_bar, kLeastLimit_bar});
    if (low < high) sum += over_line(kLimits[i], kLimits[i + 1], low, high);
  }
  return sum + std::max(to_bar - std::max(from_bar, kLeastLimit_bar), 0.0) / kLeastLimit_min;
}

double otu_rate(double po2_bar) {
  return std::pow(std::max(po2_bar - kOtuFrom_bar, 0.0) / 0.5, 5.0 / 6.0);
}

// Integral of otu_rate d pO2 from 0.5 on.
double otu_over(double po2_bar) {
  return 0.5 * (6.0 / 11.0) * std::pow(std::max(po2_bar - kOtuFrom_bar, 0.0) / 0.5, 11.0 / 6.0);
}

}  // namespace

double cns_limit_min(double po2_bar) {
  if (po2_bar <= kLimits[0].po2_bar) return std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < std::size(kLimits); ++i)
    if (po2_bar <= kLimits[i + 1].po2_bar)
      return std::max(on_line(kLimits[i], kLimits[i + 1], po2_bar), kLeastLimit_min);
  return kLeastLimit_min;
}

OxygenExposure oxygen_exposure(double from_po2_bar, double to_po2_bar, double minutes,
                               double cns_from_bar) {
  const double low = std::min(from_po2_bar, to_po2_bar), high = std::max(from_po2_bar, to_po2_bar);
  if (high <= kOtuFrom_bar || !(minutes > 0.0)) return {};
  // Where it hardly changes, the quotient below would lose its digits.
  if (high - low < 1e-7 * high) {
    const double middle = 0.5 * (low + high);
    return {middle > cns_from_bar ? 100.0 * minutes / cns_limit_min(middle) : 0.0,
            minutes * otu_rate(middle)};
  }
  const double minutes_a_bar = minutes / (high - low);
  return {
      100.0 * minutes_a_bar * over_table(std::max(low, cns_from_bar), std::max(high, cns_from_bar)),
      minutes_a_bar * (otu_over(high) - otu_over(low))};
}

double cns_after(double cns_percent, double minutes) {
  return cns_percent * std::exp2(-minutes / 90.0);
}

OxygenExposure exposure_after(const OxygenExposure& before, const OxygenExposure& added,
                              double surface_min) {
  const double cns = before.cns_percent + added.cns_percent;
  return {added.cns_percent > 0.0 ? cns : cns_after(cns, surface_min), before.otu + added.otu};
}

double max_operating_depth_m(const GasMix& mix, double po2_bar, const DecoEnvironment& where) {
  return where.depth_m(po2_bar / mix.oxygen);
}

double usual_switch_depth_m(const GasMix& mix) {
  constexpr double kPo2_bar = 1.6;
  const double depth_m = max_operating_depth_m(mix, kPo2_bar, kTenMetresABar);
  return std::max(3.0 * std::floor(depth_m / 3.0 + 1e-9), 0.0);
}

double narcotic_depth_m(const GasMix& mix, double depth_m, const DecoEnvironment& where) {
  return where.depth_m(where.pressure_bar(depth_m) * (1.0 - mix.helium));
}

double air_depth_m(const GasMix& mix, double depth_m, const DecoEnvironment& where) {
  return where.depth_m(where.pressure_bar(depth_m) * mix.nitrogen() / kAir.nitrogen());
}

double gas_density_g_l(const GasMix& mix, double pressure_bar) {
  return pressure_bar * (1.429 * mix.oxygen + 1.2505 * mix.nitrogen() + 0.179 * mix.helium);
}

}  // namespace neritic::diver
