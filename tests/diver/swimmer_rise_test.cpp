// A diver who swims up to a place well above: no faster than the computer's alarm allows, without
// overshooting it, and level and calm there.
#include <gtest/gtest.h>

#include "diver/deco_ascent_rate.hpp"
#include "tests/diver/swims.hpp"
#include "tests/support/support.hpp"

namespace neritic::diver {
namespace {

// Level swims for 20 s, so that the body has way, then to a place at to_m so far ahead of where
// that ends; hovers there once within a metre, as in a scene.
struct RiseCase {
  const char* name;
  double from_m, to_m, ahead_m, speed_m_s;
  BodyParameters diver;
};

struct Rise {
  double rate_m_min = 0.0;                  // the fastest, as the dive computer says it
  double alarm_s = 0.0;                     // so long it said so
  double over_m = 0.0;                      // above the place
  double risen_s = -1.0, arrived_s = -1.0;  // within 0.5 m of the depth, within 1 m of the place
  // From a minute after arriving on, for another.
  double off_depth_m = 0.0, pitch_deg = 0.0;
};

Rise rise_of(const RiseCase& c) {
  const Body body = make_body(c.diver).value();
  Swim s = begin(body, {-20.0 * c.speed_m_s, 0.0, c.from_m}, 0.0);
  swim_for(body, s, {{1000.0, 0.0, c.from_m}, c.speed_m_s}, 20.0, [](const HumanState&) {});
  const Vec3 place(s.state.root.position_ned_m.x + c.ahead_m, 0.0, c.to_m);
  Rise out;
  AscentRateState rate;
  const AscentRateLimits limits;
  double now_s = 0.0;
  bool calm = false;
  const auto see = [&](const HumanState& state) {
    const Vec3& p = state.root.position_ned_m;
    now_s += 1.0 / 240.0;
    rate = observe(rate, p.z, 1.0 / 240.0, limits);
    if (now_s > 10.0) out.rate_m_min = std::max(out.rate_m_min, rate.rate_m_min);
    if (alarm_of(rate, limits) != AscentAlarm::kNone) out.alarm_s += 1.0 / 240.0;
    out.over_m = std::max(out.over_m, c.to_m - p.z);
    if (out.risen_s < 0.0 && p.z < c.to_m + 0.5) out.risen_s = now_s;
    if (!calm) return;
    out.off_depth_m = std::max(out.off_depth_m, std::abs(p.z - c.to_m));
    out.pitch_deg =
        std::max(out.pitch_deg, std::abs(degrees(attitude_of(state.root.attitude).pitch_rad)));
  };
  while (glm::distance(s.state.root.position_ned_m, place) > 1.0) {
    if (now_s > 400.0) return out;
    swim_for(body, s, {place, c.speed_m_s}, 1.0 / 60.0, see);
  }
  out.arrived_s = now_s;
  swim_for(body, s, {place, 0.0}, 60.0, see);
  calm = true;
  swim_for(body, s, {place, 0.0}, 60.0, see);
  return out;
}

BodyParameters in_suit(double thickness_m) {
  BodyParameters p;
  p.gear.suit = Suit{thickness_m};
  return p;
}
BodyParameters with_twin(double suit_m) {
  BodyParameters p = in_suit(suit_m);
  Tank half = tank_of(0.012);
  half.pressure_pa = 232e5;
  p.gear.tanks = {half, half};
  return p;
}

// The gas in jacket and suit doubles from 20 m to 5 m. A diver who does not vent it is
// carried to the surface: the fins' share of the rate is small.
TEST(Swimmer, RisesNoFasterThanTaughtAndStopsAtThePlace) {
  BodyParameters no_suit, half_empty, small, large_tank;
  no_suit.gear.suit.reset();
  half_empty.gear.tanks[0].pressure_pa = 100e5;
  small.build = {Sex::kFemale, 1.58, 50.0};
  large_tank.gear.tanks = {tank_of(0.015)};
  large_tank.gear.tanks[0].pressure_pa = 232e5;
  // The ends of each: steep and level way, thin and thick suits, light and heavy gear.
  std::vector<RiseCase> cases{{"straight up", 20.0, 5.0, 0.0, 0.4, {}},
                              {"a little", 9.0, 3.0, 10.0, 0.4, {}},
                              {"no suit", 20.0, 5.0, 8.7, 0.4, no_suit},
                              {"twin, 7 mm", 30.0, 5.0, 8.7, 0.5, with_twin(0.007)},
                              {"small", 20.0, 5.0, 8.7, 0.4, small}};
  if (test::is_thorough())
    for (const RiseCase& c : {RiseCase{"steeply", 20.0, 5.0, 8.7, 0.5, {}},
                              {"with level way", 20.0, 5.0, 40.0, 0.4, {}},
                              {"slowly", 20.0, 5.0, 0.0, 0.3, {}},
                              {"3 mm", 20.0, 5.0, 8.7, 0.4, in_suit(0.003)},
                              {"7 mm", 30.0, 5.0, 15.0, 0.5, in_suit(0.007)},
                              {"15 l", 20.0, 5.0, 0.0, 0.4, large_tank},
                              {"twin", 40.0, 5.0, 10.0, 0.45, with_twin(0.005)},
                              {"100 bar", 30.0, 5.0, 15.0, 0.4, half_empty}})
      cases.push_back(c);
  for (const RiseCase& c : cases) {
    const Rise rise = rise_of(c);
    EXPECT_LT(rise.rate_m_min, 8.5) << c.name;
    EXPECT_EQ(rise.alarm_s, 0.0) << c.name;
    EXPECT_LT(rise.over_m, 0.4) << c.name;
    // No slower than it must, either: at 0.12 m/s but for the start and the end.
    const double fastest_s = (c.from_m - c.to_m) / 0.12;
    EXPECT_GT(rise.risen_s, 0.0) << c.name;
    EXPECT_LT(rise.risen_s, fastest_s + 15.0) << c.name;
    EXPECT_GT(rise.arrived_s, 0.0) << c.name;
    EXPECT_LT(rise.arrived_s, fastest_s + 75.0) << c.name;
    EXPECT_LT(rise.off_depth_m, 0.35) << c.name;
    EXPECT_LT(rise.pitch_deg, 15.0) << c.name;
  }
}

// A jacket that lifts too little is filled, as far as fins and breath hold the rest.
TEST(Swimmer, WhoIsTooHeavyFillsTheJacketToRise) {
  const Body body = body_with(Gear{});
  Swim s = begin(body, {0.0, 0.0, 20.0}, 0.0);
  const double neutral_moles = s.state.life.jacket_moles;
  s.state.life.jacket_moles = 0.0;
  const auto nothing = [](const HumanState&) {};
  swim_for(body, s, {{100.0, 0.0, 5.0}, 0.4}, 30.0, nothing);
  EXPECT_GT(s.state.life.jacket_moles, 0.7 * neutral_moles);
  const double then_m = s.state.root.position_ned_m.z;
  EXPECT_LT(then_m, 19.0);
  swim_for(body, s, {{100.0, 0.0, 5.0}, 0.4}, 60.0, nothing);
  EXPECT_NEAR(then_m - s.state.root.position_ned_m.z, 7.5, 1.0);
}

}  // namespace
}  // namespace neritic::diver
