// The risk proxies against the figures they are made of.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "diver/risk_proxies.hpp"

namespace neritic::diver {
namespace {

TEST(RiskProxies, Co2IsThatOfTheAlveolarEquation) {
  EXPECT_NEAR(arterial_co2_mmhg(0.2, 4.3), 40.139534883720934, 1e-9);
  EXPECT_NEAR(alveolar_ventilation(10.0, 0.3), 7.0, 1e-12);
  EXPECT_NEAR(swimming_oxygen_l_min(0.5), 1.2225, 1e-12);
  EXPECT_NEAR(swimming_oxygen_l_min(0.9), 2.6593, 1e-4);
}

// 18/45 at 60 m is as narcotic as air at 28.5 m, in tables of 10 m a bar.
TEST(RiskProxies, NarcoticDepthIsTheEquivalentDepthOfTheTables) {
  const auto at = [](double depth_m, double oxygen, double helium) {
    RiskInput in;
    in.surface_pa = 1e5;
    in.ambient_pa = 1e5 + 1e4 * depth_m;
    in.oxygen = oxygen;
    in.helium = helium;
    return assess_risk({}, in);
  };
  EXPECT_NEAR(at(60.0, 0.18, 0.45).narcotic_depth_m, 28.5, 1e-9);
  EXPECT_NEAR(at(120.0, 0.10, 0.70).narcotic_depth_m, 29.0, 1e-9);
  EXPECT_NEAR(at(40.0, 0.21, 0.0).narcotic_depth_m, 40.0, 1e-9);
  EXPECT_EQ(at(20.0, 0.21, 0.0).narcosis, RiskLevel::kLow);
  EXPECT_EQ(at(35.0, 0.21, 0.0).narcosis, RiskLevel::kRaised);
  EXPECT_EQ(at(70.0, 0.21, 0.0).narcosis, RiskLevel::kSevere);
}

TEST(RiskProxies, LessBreathForTheSameWorkIsMoreRisk) {
  RiskLevel last = RiskLevel::kLow;
  double last_mmhg = 0.0;
  for (const double ventilation : {45.0, 36.0, 31.0, 25.0, 0.0}) {
    RiskInput in;
    in.oxygen_uptake_l_min = 1.5;
    in.ventilation_l_min = ventilation;
    const RiskProxies risk = assess_risk({}, in);
    EXPECT_GT(risk.co2_mmhg, last_mmhg);
    EXPECT_GE(risk.co2, last);
    last_mmhg = risk.co2_mmhg;
    last = risk.co2;
  }
  EXPECT_EQ(last, RiskLevel::kSevere);
  EXPECT_TRUE(std::isfinite(last_mmhg));
}

TEST(RiskProxies, DenseGasAndBreathHaveTheirPublishedLimits) {
  RiskInput in;
  for (const auto& [density, level] :
       {std::pair{5.152, RiskLevel::kLow}, {5.6, RiskLevel::kRaised}, {6.44, RiskLevel::kHigh}}) {
    in.gas_density_kg_m3 = density;
    EXPECT_EQ(assess_risk({}, in).gas_density, level);
  }
  in.breath_rate_bpm = 26.0;
  EXPECT_EQ(assess_risk({}, in).breathing, RiskLevel::kRaised);
  in.pause_s = 20.0;
  EXPECT_EQ(assess_risk({}, in).breathing, RiskLevel::kHigh);
}

// 1.4 and 1.6 bar, 80 and 100 % of the CNS limit; and too little: air at 4 500 m of altitude has
// 0.121 bar, a hypoxic 10/70 at the surface 0.10.
TEST(RiskProxies, OxygenHasItsLimitsBothWays) {
  const auto at = [](double oxygen, double ambient_bar, double cns_percent = 0.0) {
    RiskInput in;
    in.oxygen = oxygen;
    in.ambient_pa = 1e5 * ambient_bar;
    in.cns_percent = cns_percent;
    const RiskProxies risk = assess_risk({}, in);
    EXPECT_NEAR(risk.oxygen_bar, oxygen * ambient_bar, 1e-12);
    return risk.oxygen;
  };
  EXPECT_EQ(at(0.32, 4.3), RiskLevel::kLow);     // 1.376 bar
  EXPECT_EQ(at(0.32, 4.5), RiskLevel::kRaised);  // 1.44
  EXPECT_EQ(at(1.0, 1.61), RiskLevel::kHigh);
  EXPECT_EQ(at(1.0, 2.5), RiskLevel::kSevere);
  EXPECT_EQ(at(0.21, 1.0, 79.0), RiskLevel::kLow);
  EXPECT_EQ(at(0.21, 1.0, 81.0), RiskLevel::kRaised);
  EXPECT_EQ(at(0.21, 1.0, 101.0), RiskLevel::kHigh);
  EXPECT_EQ(at(0.21, 1.0, 151.0), RiskLevel::kSevere);
  EXPECT_EQ(at(0.21, 0.80), RiskLevel::kRaised);  // 0.168
  EXPECT_EQ(at(0.21, 0.577), RiskLevel::kHigh);
  EXPECT_EQ(at(0.10, 0.99), RiskLevel::kSevere);
}

// Air at a lake at 3000 m is no risk; a hypoxic gas is one there too.
TEST(RiskProxies, AirInTheMountainsIsNoRisk) {
  RiskInput in;
  in.ambient_pa = in.surface_pa = 70.1e3;
  EXPECT_EQ(assess_risk({}, in).oxygen, RiskLevel::kLow);
  in.oxygen = 0.20;
  EXPECT_EQ(assess_risk({}, in).oxygen, RiskLevel::kHigh);
  in.oxygen = 0.14;
  EXPECT_EQ(assess_risk({}, in).oxygen, RiskLevel::kSevere);
  in.surface_pa = 101325.0;  // flown there
  in.oxygen = 0.21;
  EXPECT_EQ(assess_risk({}, in).oxygen, RiskLevel::kHigh);
}

TEST(RiskProxies, WhatNoDiverHasIsRefusedCountedAndTheLastGoodOnesHeld) {
  RiskInput good;
  good.ambient_pa = 4e5;
  const RiskProxies before = assess_risk({}, good);
  RiskProxies now = before;
  int refused = 0;
  double RiskInput::*const kFields[] = {&RiskInput::ambient_pa,
                                        &RiskInput::surface_pa,
                                        &RiskInput::oxygen,
                                        &RiskInput::helium,
                                        &RiskInput::gas_density_kg_m3,
                                        &RiskInput::oxygen_uptake_l_min,
                                        &RiskInput::ventilation_l_min,
                                        &RiskInput::cns_percent,
                                        &RiskInput::breath_rate_bpm,
                                        &RiskInput::pause_s};
  for (double RiskInput::*const field : kFields)
    for (const double bad : {std::nan(""), -1.0, 1e30, HUGE_VAL}) {
      RiskInput in = good;
      in.*field = bad;
      now = assess_risk(now, in);
      EXPECT_EQ(now.refused, static_cast<std::uint64_t>(++refused));
      EXPECT_EQ(now.co2_mmhg, before.co2_mmhg);
      EXPECT_EQ(now.narcotic_depth_m, before.narcotic_depth_m);
    }
  EXPECT_NE(std::strstr(kRiskNote, "not a measurement"), nullptr);
}

}  // namespace
}  // namespace neritic::diver
