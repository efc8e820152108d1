#include "diver/exertion.hpp"

#include <algorithm>
#include <cmath>

namespace neritic::diver {
namespace {

// Work against a load, the cost of moving the limbs set apart (Whipp and Wasserman 1969, J. Appl.
// Physiol. 26, 644).
constexpr double kWorkEfficiency = 0.30;
// Metabolic watts for each watt that speeds limbs up, and that muscles or water then brake.
// Calibrated: bare feet at 0.8 m/s then cost the published 10.6 J a metre and kg (Zamparo et al.
// 2006, Eur. J. Appl. Physiol. 96, 459).
constexpr double kCostOfMoving = 10.0;
// Demand of a sprint by a rested person, of the most oxygen: spends the reserve in 100 s.
constexpr double kSprint = 1.2;
constexpr double kUsualOxygen_l_min_kg = 0.045;

double watts_of(double oxygen_l_min) {
  return std::max(0.0, oxygen_l_min - kRestingOxygen_l_min) * kJoulePerLitre / 60.0;
}

double whole_reserve_j(const Fitness& fitness) {
  return fitness.reserve_j / kWorkEfficiency;
}

}  // namespace

Status check_fitness(const Fitness& fitness) {
  if (fitness.most_oxygen_l_min != 0.0)
    NERITIC_TRY_STATUS(
        check_limits({{"most oxygen, l/min", fitness.most_oxygen_l_min, kMostOxygenUptake_l_min}}));
  return check_limits({{"critical share", fitness.critical_share, kCriticalShare},
                       {"reserve, J", fitness.reserve_j, kWorkReserve_j}});
}

double usual_most_oxygen_l_min(double mass_kg) {
  return kUsualOxygen_l_min_kg * mass_kg;
}

double metabolic_power_w(double work_w, double moving_w) {
  return std::max(0.0, work_w) / kWorkEfficiency + kCostOfMoving * std::max(0.0, moving_w);
}

double work_of_heat_w(double heat_w) {
  return kWorkEfficiency * std::max(0.0, heat_w);
}

double oxygen_for_l_min(double metabolic_w) {
  return kRestingOxygen_l_min + metabolic_w * 60.0 / kJoulePerLitre;
}

double critical_power_w(const Fitness& fitness) {
  return watts_of(fitness.critical_share * fitness.most_oxygen_l_min);
}

double strongest_power_w(const Fitness& fitness, double spent_j) {
  const double most = watts_of(kSprint * fitness.most_oxygen_l_min);
  return std::lerp(critical_power_w(fitness), most, reserve_share(fitness, spent_j));
}

double spent_after(const Fitness& fitness, double spent_j, double metabolic_w, double dt_s) {
  if (!fitness.tires) return 0.0;
  const double whole_j = whole_reserve_j(fitness);
  const double excess_w = metabolic_w - critical_power_w(fitness);
  if (excess_w >= 0.0) return std::min(whole_j, spent_j + excess_w * dt_s);
  return spent_j * std::exp(excess_w / whole_j * dt_s);
}

double reserve_share(const Fitness& fitness, double spent_j) {
  return std::clamp(1.0 - spent_j / whole_reserve_j(fitness), 0.0, 1.0);
}

double oxygen_demand_l_min(const Fitness& fitness, double metabolic_w, double spent_j) {
  const double most = fitness.most_oxygen_l_min;
  const double hard = std::min(1.0, metabolic_w / critical_power_w(fitness));
  const double slow =
      (1.0 - reserve_share(fitness, spent_j)) * hard * (1.0 - fitness.critical_share) * most;
  return std::min(most, oxygen_for_l_min(metabolic_w) + slow);
}

}  // namespace neritic::diver
