// Inert gas in a diver's tissues, and the shallowest depth that they tolerate. Pure functions over
// plain bytes; any thread. Pressures in bar (absolute), times in minutes.
#pragma once

#include "diver/buehlmann.hpp"
#include "diver/deco_environment.hpp"
#include "diver/gas_mix.hpp"

namespace neritic::diver {

// All that the model knows of a diver. Trivially copyable, without padding.
struct TissueState {
  Compartments n2_bar{}, he_bar{};
  bool operator==(const TissueState&) const = default;

  static void fields(auto&& field, auto& self) {
    field("n2_bar", self.n2_bar);
    field("he_bar", self.he_bar);
  }
};

// In equilibrium with a gas of this share of nitrogen and no helium at this pressure.
TissueState saturated(const Buehlmann& model, double pressure_bar, double n2);

// The tissues after minutes at a pressure that changes linearly: Schreiner's equation (1971),
//   p(t) = P + R (t - 1/k) - (P - p0 - R/k) e^(-k t)
// with P the gas's alveolar pressure at first, f (p_abs - p_H2O), R its rate, k = ln 2 / half-time;
// exact for any length of time. Where saturation and desaturation differ from 1, k is that many
// times as large while gas goes in, and out; the moment of change is solved for.
TissueState load(const Buehlmann& model, const TissueState& before, double from_bar, double to_bar,
                 double minutes, const GasMix& gas);

// load() many times for the same time: what can be known before, so that no step needs an
// exponential.
struct StepFactors {
  double minutes = 0.0;
  struct Gas {
    Compartments gone{};  // 1 - e^(-k t)
    Compartments ramp{};  // 1 - gone / (k t): of the change of pressure
  };
  Gas n2, he;
};
StepFactors step_factors(const Buehlmann& model, double minutes);
// Precondition: factors are the model's, and its saturation and desaturation are 1.
TissueState load(const Buehlmann& model, const StepFactors& factors, const TissueState& before,
                 double from_bar, double to_bar, const GasMix& gas);

// Least pressure that a compartment tolerates, of all the gradient from ambient pressure to the
// M-value gf of it (E. C. Baker, Clearing up the confusion about deep stops, 1998):
//   (p - a gf) / (gf / b + 1 - gf)
// a and b are those of nitrogen and helium, weighted by what the compartment holds of each.
double tolerated_bar(const Buehlmann& model, const TissueState& tissues, std::size_t compartment,
                     double gf);
struct Ceiling {
  double pressure_bar = 0.0;
  std::size_t compartment = 0;  // that leads; 0 is the first
};
Ceiling ceiling(const Buehlmann& model, const TissueState& tissues, double gf);

// How much of the way from ambient pressure to its M-value a compartment has gone at this pressure:
// 1 is at the M-value, 0 or less does not give off gas.
double gradient_share(const Buehlmann& model, const TissueState& tissues, std::size_t compartment,
                      double pressure_bar);
// The largest of all compartments.
double gradient_share(const Buehlmann& model, const TissueState& tissues, double pressure_bar);

}  // namespace neritic::diver
