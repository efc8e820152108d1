#include "rov/step_choice.hpp"

#include <iterator>

namespace neritic::rov {
namespace {

constexpr MeasuredRate kRates[] = {{80.0, 2.9e-6, 202.0},  {100.0, 1.6e-6, 250.0},
                                   {200.0, 2.2e-7, 327.0}, {400.0, 2.8e-8, 653.0},
                                   {500.0, 1.6e-8, 813.0}, {1000.0, 1.5e-9, 1627.0}};

}  // namespace

std::span<const MeasuredRate> measured_rates() {
  return kRates;
}

Result<MeasuredRate> cheapest_rate(double max_error_m) {
  for (const MeasuredRate& rate : kRates)
    if (rate.error_m <= max_error_m) return rate;
  return bad_input("max_error_m: {} found, a number from {} is accepted", max_error_m,
                   std::end(kRates)[-1].error_m);
}

}  // namespace neritic::rov
