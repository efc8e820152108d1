// A vehicle's battery against published figures, closed forms and the energy that it holds.
#include "rov/battery.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "rov/vehicle_file.hpp"

namespace neritic::rov {
namespace {

// Newtons that draw this power.
double thrust_of(const Battery& battery, double power_w) {
  const double one[] = {1.0};
  return std::pow(power_w / thruster_power_w(battery, one), 2.0 / 3.0);
}

TEST(RovBattery, ThrustersDrawWhatTheirMakerPublishes) {
  const double published[][2] = {{36.4, 205.0}, {51.5, 390.0}, {65.7, 645.0}};  // N, W
  for (const auto& [thrust_n, power_w] : published) {
    const double force[] = {-thrust_n};
    EXPECT_NEAR(thruster_power_w({}, force) / power_w, 1.0, 0.15) << thrust_n;
  }
  const double two[] = {20.0, 20.0}, one[] = {20.0};
  EXPECT_DOUBLE_EQ(thruster_power_w({}, two), 2.0 * thruster_power_w({}, one));
}

TEST(RovBattery, TheVoltageIsThatBehindItsResistance) {
  Battery b;
  for (const double power_w : {0.0, 60.0, 400.0, 1000.0}) {
    const double force[] = {thrust_of(b, power_w)};
    b.hotel_w = 0.0;
    const BatteryState next = step_battery(b, start_battery(b), force, 0.01);
    EXPECT_NEAR(next.voltage_v * next.current_a, power_w, 1e-9 * (1.0 + power_w));
    EXPECT_NEAR(next.voltage_v, 16.8 - 0.05 * next.current_a, 1e-9);
  }
  // More than it can give: what matched loads get, at half the voltage.
  const double force[] = {thrust_of(b, 1e5)};
  const BatteryState next = step_battery(b, start_battery(b), force, 0.01);
  EXPECT_NEAR(next.power_w, 16.8 * 16.8 / 4.0 / 0.05, 1e-9);
  EXPECT_NEAR(next.voltage_v, 8.4, 1e-9);
}

TEST(RovBattery, WhatItGivesAndLosesIsWhatItHeld) {
  Battery b;
  b.capacity_wh = 20.0;
  for (const double step_s : {0.01, 0.1}) {
    BatteryState state = start_battery(b);
    double given_wh = 0.0, time_s = 0.0;
    const double told_s = battery_left_s(b, step_battery(b, state, std::array{30.0, -25.0}, 1e-6));
    while (state.empty == 0) {
      state = step_battery(b, state, std::array{30.0, -25.0}, step_s);
      given_wh += (state.power_w + 0.05 * state.current_a * state.current_a) * step_s / 3600.0;
      time_s += step_s;
    }
    EXPECT_NEAR(given_wh, b.capacity_wh, 1e-3 * b.capacity_wh);
    // The current rises as the voltage falls: the time told at first is an upper bound.
    EXPECT_LT(time_s, told_s);
    EXPECT_GT(time_s, 0.8 * told_s);
    const BatteryState after = step_battery(b, state, std::array{30.0, -25.0}, step_s);
    EXPECT_EQ(after.current_a, 0.0);
    EXPECT_EQ(after.voltage_v, b.empty_v);
    EXPECT_EQ(battery_left_s(b, after), 0.0);
  }
}

TEST(RovBattery, AnyLoadAndStepLeavesItFinite) {
  const double kNan = std::numeric_limits<double>::quiet_NaN();
  Battery b;
  for (const double resistance : {0.0, 0.05, 10.0}) {
    b.resistance_ohm = resistance;
    for (const double force : {0.0, 5e-324, 1e9, -1e9, kNan, HUGE_VAL})
      for (const double step_s : {1e-9, 0.004, 10.0}) {
        BatteryState state = start_battery(b);
        for (int i = 0; i < 3; ++i) state = step_battery(b, state, std::array{force}, step_s);
        EXPECT_TRUE(std::isfinite(state.charge) && std::isfinite(state.voltage_v) &&
                    std::isfinite(state.current_a) && std::isfinite(battery_left_s(b, state)))
            << resistance << " " << force << " " << step_s;
        EXPECT_GE(state.charge, 0.0);
        EXPECT_LE(state.charge, 1.0);
      }
  }
}

TEST(RovBattery, FaultsOfItsTableAreNamed) {
  const auto said = [](const std::string& keys) {
    const auto file = parse_vehicle(
        "mass_kg = 10\ninertia_kg_m2 = [0.2, 0.2, 0.3]\n[battery]\n" + keys, "v.toml", ".", 1028.0);
    return file.ok() ? std::string() : file.error().message;
  };
  EXPECT_EQ(said("capacity_wh = 90\n"), "");
  EXPECT_THAT(said("capacity_wh = -1\n"),
              testing::HasSubstr("battery.capacity_wh: found -1; accepted: [0.01, 10000000]"));
  EXPECT_THAT(said("full_v = 10\n"),
              testing::HasSubstr("battery.full_v: found 10; accepted: [12.8,"));
  EXPECT_THAT(said("charge = nan\n"),
              testing::HasSubstr("battery.charge: found \"nan\"; accepted: a number"));
  EXPECT_THAT(said("volts = 3\n"), testing::HasSubstr("battery.volts: not known"));
}

}  // namespace
}  // namespace neritic::rov
