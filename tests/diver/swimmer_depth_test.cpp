// A diver in heavy gear who swims to another depth: jackets that have litres to hold make a descent
// run away where gas is not added on the way, and an ascent where it is not let out.
#include <gtest/gtest.h>

#include "diver/deco_ascent_rate.hpp"
#include "tests/diver/swims.hpp"
#include "tests/support/support.hpp"

namespace neritic::diver {
namespace {

Tank carried(double litres, double bar, const GasMix& mix) {
  Tank tank = tank_of(1e-3 * litres);
  tank.pressure_pa = 1e5 * bar;
  tank.mix = mix;
  return tank;
}

struct CarriedGear {
  const char* name;
  std::vector<Tank> tanks;
};
// The lightest and the heaviest, and one between; more where the test is thorough.
std::vector<CarriedGear> gears() {
  const GasMix nitrox{0.5, 0.0}, oxygen{1.0, 0.0}, trimix{0.18, 0.45};
  const Tank back = carried(12.0, 230.0, kAir), deep = carried(12.0, 230.0, trimix);
  const Tank stage = carried(11.1, 200.0, nitrox), last = carried(11.1, 200.0, oxygen);
  std::vector<CarriedGear> out{{"single", {back}},
                               {"twin and stage", {back, back, stage}},
                               {"twin and two stages", {deep, deep, stage, last}}};
  if (test::is_thorough()) {
    out.push_back({"twin", {back, back}});
    out.push_back({"24 l and stage", {carried(24.0, 230.0, kAir), stage}});
  }
  return out;
}

struct DepthChange {
  double from_m, to_m, ahead_m;
};

// The second where the test is thorough.
std::vector<DepthChange> changes(const DepthChange& always, const DepthChange& more) {
  return test::is_thorough() ? std::vector{always, more} : std::vector{always};
}

struct ChangeTrack {
  double past_m = 0.0;      // beyond the place's depth
  double back_m = 0.0;      // beyond the first depth, the other way
  double sink_m_min = 0.0;  // over six seconds
  double dangerous_s = 0.0, alarm_s = 0.0;
  double at_depth_s = -1.0, arrived_s = -1.0;
  double off_depth_m = 0.0;  // from a minute after arriving on, for another
};
ChangeTrack track_change(const Body& body, const DepthChange& c) {
  constexpr double kSpeed_m_s = 0.4;
  Swim s = begin(body, {-20.0 * kSpeed_m_s, 0.0, c.from_m}, 0.0);
  swim_for(body, s, {{1000.0, 0.0, c.from_m}, kSpeed_m_s}, 20.0, [](const HumanState&) {});
  const Vec3 place(s.state.root.position_ned_m.x + c.ahead_m, 0.0, c.to_m);
  const double down = c.to_m > c.from_m ? 1.0 : -1.0;
  ChangeTrack out;
  AscentRateState rate;
  const AscentRateLimits limits;
  std::vector<double> depths_m;
  bool calm = false;
  const auto see = [&](const HumanState& state) {
    const double depth_m = state.root.position_ned_m.z;
    out.past_m = std::max(out.past_m, down * (depth_m - c.to_m));
    out.back_m = std::max(out.back_m, down * (c.from_m - depth_m));
    rate = observe(rate, depth_m, 1.0 / 240.0, limits);
    const AscentAlarm alarm = alarm_of(rate, limits);
    if (alarm != AscentAlarm::kNone) out.alarm_s += 1.0 / 240.0;
    if (alarm == AscentAlarm::kDangerous) out.dangerous_s += 1.0 / 240.0;
    depths_m.push_back(depth_m);
    const std::size_t before = 6 * 240, now = depths_m.size() - 1;
    if (now >= before)
      out.sink_m_min = std::max(out.sink_m_min, 10.0 * (depth_m - depths_m[now - before]));
    if (out.at_depth_s < 0.0 && std::abs(depth_m - c.to_m) < 0.5)
      out.at_depth_s = static_cast<double>(now) / 240.0;
    if (calm) out.off_depth_m = std::max(out.off_depth_m, std::abs(depth_m - c.to_m));
  };
  while (glm::distance(s.state.root.position_ned_m, place) > 1.0) {
    if (depths_m.size() > 400 * 240) return out;
    swim_for(body, s, {place, kSpeed_m_s}, 1.0 / 60.0, see);
  }
  out.arrived_s = static_cast<double>(depths_m.size()) / 240.0;
  swim_for(body, s, {place, 0.0}, 60.0, see);
  calm = true;
  swim_for(body, s, {place, 0.0}, 60.0, see);
  return out;
}

void expect_reached(const CarriedGear& gear, const DepthChange& change, double most_past_m,
                    double rate_m_s) {
  BodyParameters diver;
  diver.gear.tanks = gear.tanks;
  const ChangeTrack track = track_change(make_body(diver).value(), change);
  const std::string what =
      fmt::format("{}, {} to {} m, {} m on", gear.name, change.from_m, change.to_m, change.ahead_m);
  EXPECT_LT(track.past_m, most_past_m) << what;
  EXPECT_LT(track.back_m, 0.3) << what;
  EXPECT_EQ(track.dangerous_s, 0.0) << what;
  EXPECT_LT(track.sink_m_min, 14.0) << what;
  EXPECT_LT(track.off_depth_m, 0.5) << what;
  const double fastest_s = std::abs(change.to_m - change.from_m) / rate_m_s;
  EXPECT_GT(track.at_depth_s, 0.0) << what;
  EXPECT_LT(track.at_depth_s, fastest_s + 20.0) << what;
  EXPECT_GT(track.arrived_s, 0.0) << what;
  EXPECT_LT(track.arrived_s, std::max(fastest_s, change.ahead_m / 0.4) + 75.0) << what;
  if (change.to_m > change.from_m) {
    EXPECT_EQ(track.alarm_s, 0.0) << what;
  }
}

// Gas that the way down presses together makes a twin set with a stage 3 l too heavy, and legs
// cannot hold the head up against that: the diver sank, head down, past any place.
TEST(Swimmer, SinksToAPlaceInWhateverGearAndStopsThere) {
  for (const CarriedGear& gear : gears())
    for (const DepthChange& down : changes({5.0, 30.0, 20.0}, {5.0, 15.0, 20.0}))
      expect_reached(gear, down, 0.8, 0.15);
}

TEST(Swimmer, RisesToAPlaceInWhateverGearAndStopsThere) {
  for (const CarriedGear& gear : gears())
    for (const DepthChange& up : changes({20.0, 10.0, 60.0}, {30.0, 5.0, 100.0}))
      expect_reached(gear, up, 0.6, 0.12);
}

}  // namespace
}  // namespace neritic::diver
