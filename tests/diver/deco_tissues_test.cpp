// Tissues and ceilings: published values, and what holds for any of them.
#include "diver/deco_tissues.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>
#include <type_traits>

#include "engine/sim/fields.hpp"

namespace neritic::diver {
namespace {

Buehlmann model_b() {
  return buehlmann(BuehlmannTable::kB, FirstCompartment::k5Min, 0.0627);
}

TissueState tissues_of(double n2_bar, double he_bar = 0.0) {
  TissueState tissues;
  tissues.n2_bar.fill(n2_bar);
  tissues.he_bar.fill(he_bar);
  return tissues;
}

double difference(const TissueState& a, const TissueState& b) {
  double worst = 0.0;
  for (std::size_t i = 0; i < kCompartments; ++i)
    worst =
        std::max({worst, std::abs(a.n2_bar[i] - b.n2_bar[i]), std::abs(a.he_bar[i] - b.he_bar[i])});
  return worst;
}

TEST(DecoTissues, FollowSchreinersPublishedExamples) {
  const Buehlmann model = model_b();
  const GasMix ean32{0.32, 0.0};
  TissueState t = tissues_of(0.919397);
  t = load(model, t, 4.0, 4.0, 20.0, ean32);
  EXPECT_NEAR(t.n2_bar[0], 2.567491, 5e-7);
  t = load(model, t, 4.0, 2.0, 2.0, ean32);
  EXPECT_NEAR(t.n2_bar[0], 2.42184, 5e-6);
  EXPECT_NEAR(load(model, tissues_of(3.0), 4.0, 3.0, 1.0, kAir).n2_bar[0], 2.96198, 1e-5);
  EXPECT_NEAR(load(model, tissues_of(3.0), 4.0, 5.0, 1.0, kAir).n2_bar[0], 3.06661, 1e-5);
}

TEST(DecoTissues, CeilingsAreThePublishedOnes) {
  const Buehlmann model = model_b();
  EXPECT_NEAR(tolerated_bar(model, tissues_of(3.0), 0, 0.3), 2.140137, 5e-7);
  EXPECT_NEAR(tolerated_bar(model, tissues_of(3.0), 0, 1.0), 1.020997, 5e-7);
  EXPECT_NEAR(tolerated_bar(model, tissues_of(2.2, 0.8), 0, 0.3), 2.074876, 5e-7);
  EXPECT_NEAR(tolerated_bar(model, tissues_of(2.2, 0.8), 0, 1.0), 0.917308, 5e-7);
}

TEST(DecoTissues, ACeilingIsWhereTheGradientShareIsTheFactor) {
  const Buehlmann model = buehlmann(BuehlmannTable::kC, FirstCompartment::k4Min, 0.0627);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> bar(0.5, 8.0), gf(0.05, 1.0);
  for (int i = 0; i < 200; ++i) {
    TissueState t;
    for (std::size_t c = 0; c < kCompartments; ++c) {
      t.n2_bar[c] = bar(random);
      t.he_bar[c] = i % 2 ? bar(random) : 0.0;
    }
    const double factor = gf(random);
    const Ceiling worst = ceiling(model, t, factor);
    EXPECT_NEAR(gradient_share(model, t, worst.compartment, worst.pressure_bar), factor, 1e-9);
    EXPECT_NEAR(gradient_share(model, t, worst.pressure_bar), factor, 1e-9);
  }
}

// Steps of any length give the same as one: the equation is exact for linear changes.
TEST(DecoTissues, ManyStepsAreOneStep) {
  Buehlmann model = model_b();
  for (const double uneven : {1.0, 1.2}) {
    model.saturation = uneven;
    model.desaturation = 1.0 / uneven;
    const GasMix trimix{0.18, 0.45};
    const TissueState start = tissues_of(1.9, 0.7);
    const TissueState once = load(model, start, 7.0, 1.2, 13.0, trimix);
    TissueState steps = start;
    for (int i = 0; i < 1000; ++i)
      steps =
          load(model, steps, 7.0 - 5.8 * i / 1000.0, 7.0 - 5.8 * (i + 1) / 1000.0, 0.013, trimix);
    EXPECT_LT(difference(once, steps), 1e-12) << uneven;
  }
}

// Against a small-step integration of p' = k (P - p), with the rates of taking up and giving off.
TEST(DecoTissues, SaturationMultipliersObeyTheirEquation) {
  Buehlmann model = model_b();
  model.saturation = 1.1;
  model.desaturation = 0.9;
  const double from = 4.0, to = 1.0, minutes = 6.0, start = 2.0;
  const TissueState exact = load(model, tissues_of(start), from, to, minutes, kAir);
  for (const std::size_t c : {0u, 3u, 8u}) {
    double p = start;
    constexpr int kSteps = 200000;
    const double dt = minutes / kSteps;
    for (int i = 0; i < kSteps; ++i) {
      const double lungs = 0.79 * (from + (to - from) * (i + 0.5) / kSteps - 0.0627);
      const double k = std::numbers::ln2 / model.n2.half_time_min[c] *
                       (lungs > p ? model.saturation : model.desaturation);
      p += k * dt * (lungs - p) / (1.0 + 0.5 * k * dt);
    }
    EXPECT_NEAR(exact.n2_bar[c], p, 1e-7) << c;
  }
  model.saturation = model.desaturation = 1.0;
  EXPECT_GT(difference(exact, load(model, tissues_of(start), from, to, minutes, kAir)), 0.01);
}

TEST(DecoTissues, ManyTimesTheSameStepIsTheSameAsEach) {
  const Buehlmann model = model_b();
  const TissueState start = tissues_of(2.0, 0.5);
  for (const double minutes : {0.0, 1e-9, 1.0 / 60.0, 1.0, 1e4}) {
    const StepFactors factors = step_factors(model, minutes);
    for (const double to_bar : {3.0, 1.0, 6.0})
      EXPECT_LT(difference(load(model, factors, start, 3.0, to_bar, {0.5, 0.1}),
                           load(model, start, 3.0, to_bar, minutes, {0.5, 0.1})),
                1e-14)
          << minutes;
  }
}

TEST(DecoTissues, NoTimeChangesNothingAndAllTimeSaturates) {
  const Buehlmann model = model_b();
  const TissueState start = tissues_of(2.0, 0.5);
  EXPECT_EQ(load(model, start, 31.0, 1.0, 0.0, kAir), start);
  // From 300 m to the surface within a nanosecond: no digits are lost.
  EXPECT_LT(difference(load(model, start, 31.0, 1.0, 1e-11, kAir), start), 1e-9);
  const double ten_years_min = 10.0 * 365.25 * 24.0 * 60.0;
  const TissueState old = load(model, start, 1.0, 1.0, ten_years_min, kAir);
  EXPECT_LT(difference(old, saturated(model, 1.0, 0.79)), 1e-12);
  EXPECT_LT(difference(load(model, start, 1.0, 1.0, 1e300, kAir), old), 1e-12);
  const TissueState oxygen = load(model, start, 101.0, 101.0, ten_years_min, {1.0, 0.0});
  EXPECT_LT(difference(oxygen, TissueState{}), 1e-12);
  EXPECT_TRUE(std::isfinite(ceiling(model, oxygen, 0.3).pressure_bar));
}

TEST(DecoTissues, AStateIsPlainBytesWithoutPadding) {
  static_assert(std::is_trivially_copyable_v<TissueState>);
  sim::check_fields_cover(TissueState{});
  sim::check_fields_cover(DecoEnvironment{});
}

TEST(DecoTissues, TheStandardAtmosphereThinsWithHeight) {
  EXPECT_NEAR(surface_bar_at(0.0), 1.01325, 1e-12);
  EXPECT_NEAR(surface_bar_at(1500.0), 0.845560048, 1e-9);
  EXPECT_NEAR(surface_bar_at(5000.0), 0.54020, 5e-6);  // the standard's table
  EXPECT_NEAR(bar_per_m_of(1030.0), 0.101008495, 1e-12);
}

}  // namespace
}  // namespace neritic::diver
