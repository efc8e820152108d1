#include "diver/deco_tissues.hpp"

#include <algorithm>
#include <cmath>

namespace neritic::diver {
namespace {

struct Coefficients {
  double a, b;
};

Coefficients mixed(const Buehlmann& model, const TissueState& tissues, std::size_t i) {
  const double n2 = tissues.n2_bar[i], he = tissues.he_bar[i], sum = n2 + he;
  if (he == 0.0 || !(sum > 0.0)) return {model.n2.a_bar[i], model.n2.b[i]};
  return {(model.n2.a_bar[i] * n2 + model.he.a_bar[i] * he) / sum,
          (model.n2.b[i] * n2 + model.he.b[i] * he) / sum};
}

double tissue_bar(const TissueState& tissues, std::size_t i) {
  return tissues.n2_bar[i] + tissues.he_bar[i];
}

// One compartment and gas. alveolar: at first; slope: its bar a minute. Schreiner's terms are
// ordered so that none is large where minutes are few and the slope is steep.
double schreiner(double tissue, double alveolar, double slope, double k, double minutes) {
  const double x = k * minutes, gone = -std::expm1(-x);
  return tissue + (alveolar - tissue) * gone + slope * minutes * (1.0 - gone / x);
}

// The same where gas goes in and out at different rates. The lead of the alveolar pressure obeys
// lead' = slope - k lead; it changes sign at most once, where slope / k is its other sign.
double schreiner_uneven(double tissue, double alveolar, double slope, double k_in, double k_out,
                        double minutes) {
  const double lead = alveolar - tissue;
  const bool in = lead > 0.0 || (lead == 0.0 && slope > 0.0);
  const double k = in ? k_in : k_out;
  const double turn =
      slope != 0.0 && lead * slope < 0.0 ? std::log1p(-lead * k / slope) / k : minutes;
  if (turn >= minutes) return schreiner(tissue, alveolar, slope, k, minutes);
  const double met = alveolar + slope * turn;
  return schreiner(met, met, slope, in ? k_out : k_in, minutes - turn);
}

void load_gas(const Buehlmann& model, const InertGas& gas, const Compartments& before,
              double alveolar, double slope, double minutes, Compartments& after) {
  const bool uneven = model.saturation != 1.0 || model.desaturation != 1.0;
  for (std::size_t i = 0; i < kCompartments; ++i) {
    const double k = gas.rate_min[i];
    after[i] = uneven ? schreiner_uneven(before[i], alveolar, slope, model.saturation * k,
                                         model.desaturation * k, minutes)
                      : schreiner(before[i], alveolar, slope, k, minutes);
  }
}

}  // namespace

TissueState saturated(const Buehlmann& model, double pressure_bar, double n2) {
  TissueState tissues;
  tissues.n2_bar.fill(n2 * (pressure_bar - model.water_vapour_bar));
  return tissues;
}

TissueState load(const Buehlmann& model, const TissueState& before, double from_bar, double to_bar,
                 double minutes, const GasMix& gas) {
  if (!(minutes > 0.0)) return before;
  const double lungs = from_bar - model.water_vapour_bar, rate = (to_bar - from_bar) / minutes;
  TissueState after;
  load_gas(model, model.n2, before.n2_bar, gas.nitrogen() * lungs, gas.nitrogen() * rate, minutes,
           after.n2_bar);
  // Most divers have no helium in them and breathe none: nothing stays nothing.
  if (gas.helium != 0.0 || before.he_bar != Compartments{})
    load_gas(model, model.he, before.he_bar, gas.helium * lungs, gas.helium * rate, minutes,
             after.he_bar);
  return after;
}

StepFactors step_factors(const Buehlmann& model, double minutes) {
  StepFactors factors{minutes, {}, {}};
  const auto fill = [&](const InertGas& gas, StepFactors::Gas& out) {
    for (std::size_t i = 0; i < kCompartments; ++i) {
      const double x = gas.rate_min[i] * minutes;
      out.gone[i] = -std::expm1(-x);
      out.ramp[i] = x > 0.0 ? 1.0 - out.gone[i] / x : 0.0;
    }
  };
  fill(model.n2, factors.n2);
  fill(model.he, factors.he);
  return factors;
}

TissueState load(const Buehlmann& model, const StepFactors& factors, const TissueState& before,
                 double from_bar, double to_bar, const GasMix& gas) {
  const double lungs = from_bar - model.water_vapour_bar, change = to_bar - from_bar;
  TissueState after;
  const auto step = [&](const StepFactors::Gas& f, const Compartments& old, double share,
                        Compartments& out) {
    const double alveolar = share * lungs, rise = share * change;
    for (std::size_t i = 0; i < kCompartments; ++i)
      out[i] = old[i] + (alveolar - old[i]) * f.gone[i] + rise * f.ramp[i];
  };
  step(factors.n2, before.n2_bar, gas.nitrogen(), after.n2_bar);
  step(factors.he, before.he_bar, gas.helium, after.he_bar);
  return after;
}

double tolerated_bar(const Buehlmann& model, const TissueState& tissues, std::size_t compartment,
                     double gf) {
  const auto [a, b] = mixed(model, tissues, compartment);
  return (tissue_bar(tissues, compartment) - a * gf) / (gf / b + 1.0 - gf);
}

Ceiling ceiling(const Buehlmann& model, const TissueState& tissues, double gf) {
  Ceiling worst{tolerated_bar(model, tissues, 0, gf), 0};
  for (std::size_t i = 1; i < kCompartments; ++i) {
    const double pressure = tolerated_bar(model, tissues, i, gf);
    if (pressure > worst.pressure_bar) worst = {pressure, i};
  }
  return worst;
}

double gradient_share(const Buehlmann& model, const TissueState& tissues, std::size_t compartment,
                      double pressure_bar) {
  const auto [a, b] = mixed(model, tissues, compartment);
  const double m_value = a + pressure_bar / b;
  return (tissue_bar(tissues, compartment) - pressure_bar) / (m_value - pressure_bar);
}

double gradient_share(const Buehlmann& model, const TissueState& tissues, double pressure_bar) {
  double most = gradient_share(model, tissues, 0, pressure_bar);
  for (std::size_t i = 1; i < kCompartments; ++i)
    most = std::max(most, gradient_share(model, tissues, i, pressure_bar));
  return most;
}

}  // namespace neritic::diver
