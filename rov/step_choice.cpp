#include "rov/step_choice.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "engine/core/refusal.hpp"

namespace neritic::rov {
namespace {

// The largest of 140 missions: 1.2e-3, 1.5e-3, 4.6e-4 and, without turned pulses, 1.1e-7; other
// missions of users at 80 Hz 1.9e-3. By the truth of `tradeoff physics`, sure to 9e-9 m, the last
// is 1.5e-9 m off on flights.
constexpr MeasuredRate kRates[] = {
    {80.0, 3e-3, 87.0}, {240.0, 2e-3, 160.0}, {500.0, 1e-3, 330.0}, {1000.0, 1.2e-7, 664.0}};

constexpr MeasuredContact kContacts[] = {
    {0.0, 3.3e-2, 5e-2}, {1e-4, 1.2e-4, 5e-4}, {1e-5, 4e-5, 2e-4}, {3e-6, 1e-5, 1e-4}};

double error_of(const MeasuredContact& measured, Touchable touchable) {
  return touchable == Touchable::kUneven ? measured.uneven_error_m : measured.error_m;
}

const char* where(Touchable touchable) {
  switch (touchable) {
    case Touchable::kNothing:
      return "";
    case Touchable::kEven:
      return " where something solid can be touched";
    case Touchable::kUneven:
      return " where uneven ground or a mesh with inner edges can be touched";
  }
  return "";
}

}  // namespace

std::span<const MeasuredRate> measured_rates() {
  return kRates;
}

std::span<const MeasuredContact> measured_contacts() {
  return kContacts;
}

Result<StepChoice> cheapest_step(double max_error_m, Touchable touchable) {
  const bool among_things = touchable != Touchable::kNothing;
  const auto rate = std::ranges::find_if(
      kRates, [&](const MeasuredRate& measured) { return measured.error_m <= max_error_m; });
  const auto contact = std::ranges::find_if(kContacts, [&](const MeasuredContact& measured) {
    return error_of(measured, touchable) <= max_error_m;
  });
  if (rate == std::end(kRates) || (among_things && contact == std::end(kContacts))) {
    const double least_m =
        among_things ? error_of(std::end(kContacts)[-1], touchable) : std::end(kRates)[-1].error_m;
    return refusal("max_error_m", fmt::format("{}", max_error_m),
                   fmt::format("a number from {}{}", least_m, where(touchable)));
  }
  return StepChoice{rate->hz, among_things ? contact->within_m : 0.0};
}

}  // namespace neritic::rov
