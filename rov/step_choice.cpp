#include "rov/step_choice.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "engine/core/refusal.hpp"

namespace neritic::rov {
namespace {

// The last is 1.5e-9 m off what `tradeoff physics` takes for true, which itself is sure to 9e-9 m.
constexpr MeasuredRate kRates[] = {{80.0, 7e-4, 87.0}, {1000.0, 1.0e-8, 664.0}};

constexpr MeasuredContact kContacts[] = {
    {1.0 / 80.0, 3.3e-2},   {1.0 / 160.0, 2.0e-2},  {1.0 / 320.0, 8.2e-3},  {1.0 / 640.0, 5.5e-3},
    {1.0 / 1280.0, 2.8e-3}, {1.0 / 1920.0, 1.7e-3}, {1.0 / 2560.0, 7.7e-4}, {1.0 / 3840.0, 4.4e-4}};

}  // namespace

std::span<const MeasuredRate> measured_rates() {
  return kRates;
}

std::span<const MeasuredContact> measured_contacts() {
  return kContacts;
}

Result<StepChoice> cheapest_step(double max_error_m, bool among_things) {
  const double least_m =
      among_things ? std::end(kContacts)[-1].error_m : std::end(kRates)[-1].error_m;
  const auto holds = [&](const auto& measured) { return measured.error_m <= max_error_m; };
  const auto rate = std::ranges::find_if(kRates, holds);
  const auto contact = std::ranges::find_if(kContacts, holds);
  if (rate == std::end(kRates) || (among_things && contact == std::end(kContacts)))
    return refusal("max_error_m", fmt::format("{}", max_error_m),
                   fmt::format("a number from {}{}", least_m,
                               among_things ? " where something solid can be touched" : ""));
  if (!among_things) return StepChoice{rate->hz, 1};
  const double parts = std::ceil(1.0 / (rate->hz * contact->step_s) - 1e-9);
  return StepChoice{rate->hz, std::max(1, static_cast<int>(parts))};
}

}  // namespace neritic::rov
