// A diver who hovers: at the depth and the place, level, in whatever gear, and back when drifted
// off.
#include <gtest/gtest.h>

#include "diver/exertion.hpp"
#include "diver/swimmer_constants.hpp"
#include "engine/sim/fields.hpp"
#include "tests/diver/swims.hpp"
#include "tests/support/support.hpp"

namespace neritic::diver {
namespace {

TEST(Swimmer, HoversByBreathAndButtons) {
  const Body body = body_with(Gear{});
  Swim s = begin(body, {0.0, 0.0, 12.0}, 0.0);
  double farthest = 0.0;
  swim_for(body, s, {{0.0, 0.0, 12.0}, 0.0}, 180.0, [&](const HumanState& state) {
    farthest = std::max(farthest, std::abs(state.root.position_ned_m.z - 12.0));
  });
  EXPECT_LT(farthest, 0.8);
  EXPECT_LT(std::hypot(s.state.root.position_ned_m.x, s.state.root.position_ned_m.y), 0.5);
}

// The farthest from the depth, of the pitch and from the place, from a minute after arriving on.
struct Hover {
  double off_depth_m = 0.0, pitch_deg = 0.0, away_m = 0.0;
};
Hover hover_after_a_swim(double depth_m, double current_m_s, double seconds) {
  const Body body = body_with(Gear{});
  Swim s = begin(body, {-12.0, 0.0, depth_m}, 0.0);
  s.inputs.current_ned_m_s = {current_m_s, 0.0, 0.0};
  const auto nothing = [](const HumanState&) {};
  swim_for(body, s, {{0.0, 0.0, depth_m}, 0.4}, 28.0, nothing);
  const SwimGoal here{{0.0, 0.0, depth_m}, 0.0};
  swim_for(body, s, here, 60.0, nothing);
  Hover out;
  swim_for(body, s, here, seconds, [&](const HumanState& state) {
    const Vec3& p = state.root.position_ned_m;
    const double pitch_deg = degrees(attitude_of(state.root.attitude).pitch_rad);
    out.off_depth_m = std::max(out.off_depth_m, std::abs(p.z - depth_m));
    out.pitch_deg = std::max(out.pitch_deg, std::abs(pitch_deg));
    out.away_m = std::max(out.away_m, std::hypot(p.x, p.y));
  });
  return out;
}

// The jacket's gas runs to the higher end and would stand a resting diver on his head; a tank that
// empties would carry him up. Back, arms and treading fins keep him level, either dump valve lets
// gas out, and fins bring him back to the place.
TEST(Swimmer, HoversLevelAtItsPlaceWhileTheTankEmpties) {
  const bool thorough = test::is_thorough();
  for (const double depth_m : thorough ? std::vector{6.0, 15.0, 30.0} : std::vector{6.0, 30.0}) {
    // The deeper, the sooner the tank empties.
    const Hover hover = hover_after_a_swim(depth_m, 0.0,
                                           thorough         ? 900.0
                                           : depth_m > 20.0 ? 600.0
                                                            : 300.0);
    EXPECT_LT(hover.off_depth_m, 0.35) << depth_m;
    EXPECT_LT(hover.pitch_deg, 15.0) << depth_m;
    EXPECT_LT(hover.away_m, 1.0) << depth_m;
  }
  for (const double current_m_s : thorough ? std::vector{-0.11, 0.3} : std::vector{0.3}) {
    const Hover hover = hover_after_a_swim(15.0, current_m_s, thorough ? 600.0 : 200.0);
    EXPECT_LT(hover.off_depth_m, 0.4) << current_m_s;
    EXPECT_LT(hover.pitch_deg, 10.0) << current_m_s;
    EXPECT_LT(hover.away_m, 2.0) << current_m_s;
  }
}

// Little pressure: the suit lifts hips and legs, so that the jacket has to lift less at the chest.
// At 5 m that turns a straight body head down by 4 N m, as much as the back's bend can hold.
TEST(Swimmer, HoversLevelInShallowWaterWithAFullTank) {
  struct Case {
    double depth_m, current_m_s, off_m = 0.4, pitch_deg = 10.0;
  };
  std::vector<Case> cases{{5.0, 0.0}, {5.0, 0.2}, {3.0, 0.15}};
  // At 0.1 m/s hands and fins hold him in turn, which tips him most (CHECKS.md, limits).
  if (test::is_thorough()) cases.insert(cases.end(), {{5.0, 0.1, 0.42, 12.0}, {5.0, -0.15}});
  for (const Case& c : cases) {
    const Hover hover =
        hover_after_a_swim(c.depth_m, c.current_m_s, test::is_thorough() ? 300.0 : 120.0);
    EXPECT_LT(hover.off_depth_m, c.off_m) << c.depth_m << " " << c.current_m_s;
    EXPECT_LT(hover.pitch_deg, c.pitch_deg) << c.depth_m << " " << c.current_m_s;
    EXPECT_LT(hover.away_m, 2.0) << c.depth_m << " " << c.current_m_s;
  }
}

// Hands and fins hold the place: within a metre in still water, within two in a current that a
// diver swims against, for little power, without spinning; also head not yet in the current.
TEST(Swimmer, StaysAtItsPlaceForLittlePower) {
  struct Case {
    double depth_m, current_m_s, toward_deg, settles_s, away_m, most_w;
  };
  // Still water, a current that hands and fins hold, and the strongest that a diver swims against.
  std::vector<Case> cases{{15.0, 0.0, 0.0, 0.0, 1.0, 10.0},
                          {4.0, 0.0, 0.0, 0.0, 1.0, 50.0},
                          {15.0, 0.05, 60.0, 180.0, 2.0, 30.0},
                          {15.0, 0.3, 120.0, 120.0, 2.0, 160.0}};
  if (test::is_thorough())
    cases.insert(cases.end(), {{15.0, 0.032, 60.0, 180.0, 2.0, 30.0},
                               {15.0, 0.1, 90.0, 120.0, 2.0, 40.0},
                               {15.0, 0.2, 60.0, 120.0, 2.0, 75.0},
                               {30.0, 0.0, 0.0, 0.0, 1.0, 20.0},
                               {5.0, 0.07, 200.0, 180.0, 2.0, 40.0}});
  const Body body = body_with(Gear{});
  for (const Case& c : cases) {
    SCOPED_TRACE(fmt::format("{} m, {} m/s to {}", c.depth_m, c.current_m_s, c.toward_deg));
    Swim s = begin(body, {0.0, 0.0, c.depth_m}, 0.0);
    const double toward_rad = radians(c.toward_deg);
    s.inputs.current_ned_m_s =
        c.current_m_s * Vec3(std::cos(toward_rad), std::sin(toward_rad), 0.0);
    const SwimGoal here{{0.0, 0.0, c.depth_m}, 0.0};
    swim_for(body, s, here, c.settles_s, [](const HumanState&) {});
    const double heading = attitude_of(s.state.root.attitude).heading_rad;
    double away_m = 0.0, power_w = 0.0, turned_rad = 0.0;
    int steps = 0;
    swim_for(body, s, here, test::is_thorough() ? 600.0 : 180.0, [&](const HumanState& state) {
      const HumanAttitude attitude = attitude_of(state.root.attitude);
      away_m =
          std::max(away_m, std::hypot(state.root.position_ned_m.x, state.root.position_ned_m.y));
      turned_rad =
          std::max(turned_rad, std::abs(std::remainder(attitude.heading_rad - heading, 2.0 * kPi)));
      power_w += metabolic_power_w(state.life.limb_power_w, state.life.moving_power_w);
      ++steps;
    });
    EXPECT_LT(away_m, c.away_m);
    EXPECT_LT(power_w / steps, c.most_w);
    EXPECT_LT(turned_rad, radians(45.0));
  }
}

// Waves move a diver to and fro and change the water's motion every few seconds: the head may turn
// into them once, not after each.
TEST(Swimmer, RidesOutWaves) {
  const Body body = body_with(Gear{});
  for (const double drift_m_s : {0.0, 0.15}) {
    Swim s = begin(body, {0.0, 0.0, 8.0}, 180.0);
    const SwimGoal here{{0.0, 0.0, 8.0}, 0.0};
    double away_m = 0.0, turned_rad = 0.0, heading = 0.0;
    constexpr double kRate_1_s = 1.2, kOrbit_m_s = 0.25;  // waves of 5 s
    for (int i = 0; i < 180 * 240; ++i) {
      const double t = i / 240.0;
      s.inputs.waves_ned_m_s = {0.0, kOrbit_m_s * std::cos(kRate_1_s * t), 0.0};
      s.inputs.current_ned_m_s = s.inputs.waves_ned_m_s + Vec3(drift_m_s, 0.0, 0.0);
      s.inputs.current_change_ned_m_s2 = {0.0, -kRate_1_s * kOrbit_m_s * std::sin(kRate_1_s * t),
                                          0.0};
      s.inputs.water_acceleration_ned_m_s2 = s.inputs.current_change_ned_m_s2;
      if (i % 4 == 0) swim(body, SwimmerSettings{}, here, s.state, s.swimmer, 1.0 / 60.0, s.inputs);
      s.state = step(body, s.state, s.inputs, 1.0 / 240.0);
      const Vec3& p = s.state.root.position_ned_m;
      away_m = std::max(away_m, std::hypot(p.x, p.y));
      const double now = attitude_of(s.state.root.attitude).heading_rad;
      if (t < 120.0)
        heading = now;
      else
        turned_rad = std::max(turned_rad, std::abs(std::remainder(now - heading, 2.0 * kPi)));
    }
    EXPECT_LT(away_m, 2.0) << drift_m_s;
    EXPECT_LT(turned_rad, radians(45.0)) << drift_m_s;
  }
}

// Whatever the water does and however long a step lasts, on the place itself, at the surface and
// without any gear: the limbs' angles stay rotations, and the state finite.
TEST(Swimmer, HoversFiniteInExtremeWater) {
  for (const Model model : {Model::kFull, Model::kPlanar})
    for (const Gear& gear : {Gear{}, no_gear()})
      for (const double dt_s : {1e-9, 1.0 / 60.0, 10.0}) {
        const Body body = body_with(gear, model);
        Swim s = begin(body, {0.0, 0.0, 0.0}, 0.0);
        for (const Vec3& water :
             {Vec3(0.0), Vec3(0.0, 0.0, 3.0), Vec3(0.031, 0.0, 0.0), Vec3(-100.0, 100.0, 100.0)})
          for (const Vec3& waves : {Vec3(0.0), water, -water})
            for (int i = 0; i < 5; ++i) {
              s.inputs.current_ned_m_s = water;
              s.inputs.waves_ned_m_s = waves;
              swim(body, SwimmerSettings{}, {{0.0, 0.0, 0.0}, 0.0}, s.state, s.swimmer, dt_s,
                   s.inputs);
              s.state = step(body, s.state, s.inputs, dt_s);
              ASSERT_TRUE(sim::all_finite(s.state) && sim::all_finite(s.swimmer));
              ASSERT_EQ(s.state.refused_inputs, 0u);
            }
      }
}

// The shallowest and deepest of a hover, how fast it rose over six seconds as a dive computer says
// it, how far it swam, and when it last leaned by more than 25 degrees.
struct HoverTrack {
  double highest_m = 0.0, deepest_m = 0.0, rise_m_min = 0.0, way_m = 0.0, leaned_s = 0.0;
};
HoverTrack track_hover(const Body& body, Swim& s, double depth_m, double seconds) {
  HoverTrack out{depth_m, depth_m};
  std::vector<double> depths_m;
  Vec3 last = s.state.root.position_ned_m;
  swim_for(body, s, {{0.0, 0.0, depth_m}, 0.0}, seconds, [&](const HumanState& state) {
    const Vec3& p = state.root.position_ned_m;
    out.highest_m = std::min(out.highest_m, p.z), out.deepest_m = std::max(out.deepest_m, p.z);
    out.way_m += glm::distance(p, last), last = p;
    depths_m.push_back(p.z);
    const std::size_t before = 6 * 240, now = depths_m.size() - 1;
    if (now >= before)
      out.rise_m_min = std::max(out.rise_m_min, 10.0 * (depths_m[now - before] - p.z));
    if ((state.root.attitude * Vec3(0.0, 0.0, 1.0)).z < std::cos(radians(25.0)))
      out.leaned_s = static_cast<double>(now) / 240.0;
  });
  return out;
}

// A heavy tank above turns a diver over, one at the side leans him: lead goes where it balances,
// and what is left is held by bending to a side.
TEST(Swimmer, HoversLevelInWhateverGear) {
  struct Case {
    const char* name;
    double depth_m;
    BodyParameters diver;
  };
  const auto with_tanks = [](const std::vector<Tank>& tanks) {
    BodyParameters p;
    p.gear.tanks = tanks;
    return p;
  };
  Tank large = tank_of(0.015), half_of_twin = tank_of(0.012), stage;
  large.pressure_pa = half_of_twin.pressure_pa = 232e5;
  stage.mix.oxygen = 0.5;
  BodyParameters no_suit, thick_suit, small;
  no_suit.gear.suit.reset();
  thick_suit.gear.suit->thickness_m = 0.007;
  small.build = {Sex::kFemale, 1.58, 50.0};
  for (const Case& c : {Case{"15 l", 5.0, with_tanks({large})},
                        {"15 l", 15.0, with_tanks({large})},
                        {"twin", 30.0, with_tanks({half_of_twin, half_of_twin})},
                        {"stage", 15.0, with_tanks({Tank{}, stage})},
                        {"no suit", 15.0, no_suit},
                        {"7 mm", 15.0, thick_suit},
                        {"small", 15.0, small}}) {
    const Body body = make_body(c.diver).value();
    Swim s = begin(body, {0.0, 0.0, c.depth_m}, 0.0);
    const HoverTrack hover = track_hover(body, s, c.depth_m, test::is_thorough() ? 300.0 : 120.0);
    EXPECT_GT(hover.highest_m, c.depth_m - 0.5) << c.name;
    EXPECT_LT(hover.deepest_m, c.depth_m + 0.5) << c.name;
    EXPECT_LT(hover.rise_m_min, 3.0) << c.name;
    EXPECT_LT(hover.way_m, 50.0) << c.name;
    EXPECT_EQ(hover.leaned_s, 0.0) << c.name;
  }
}

// Nothing lifts a diver without a jacket: the lead makes him neutral where he starts, with the
// tanks that he has; at 25 m, where the suit lifts little, he wears none.
TEST(Swimmer, WithoutAJacketStartsNeutralAndStays) {
  for (const double depth_m : {3.0, 10.0, 25.0}) {
    BodyParameters diver;
    diver.gear.jacket.reset();
    diver.start_depth_m = depth_m;
    const Body body = make_body(diver).value();
    Swim s = begin(body, {0.0, 0.0, depth_m}, 0.0);
    EXPECT_NEAR(net_weight_n(body, s.state), 0.0, depth_m < 20.0 ? 2.5 : 5.0) << depth_m;
    EXPECT_EQ(body.lead_kg == 0.0, depth_m > 20.0) << depth_m;
    const HoverTrack hover = track_hover(body, s, depth_m, 60.0);
    EXPECT_GT(hover.highest_m, depth_m - 1.0) << depth_m;
    EXPECT_LT(hover.deepest_m, depth_m + 1.0) << depth_m;
  }
}

// Without the jacket's cloth to lift it, the tank on the back would turn a slow diver over.
TEST(Swimmer, WithoutAJacketDoesNotRollOver) {
  BodyParameters usual, bare_skin, big_tank;
  bare_skin.gear.suit.reset();
  big_tank.gear.suit->thickness_m = 0.007;
  big_tank.gear.tanks = {tank_of(15e-3)};
  big_tank.gear.tanks[0].pressure_pa = 230e5;
  struct Case {
    const char* name;
    BodyParameters diver;
  };
  for (Case c : {Case{"usual", usual}, {"bare skin", bare_skin}, {"big tank", big_tank}}) {
    c.diver.gear.jacket.reset();
    c.diver.start_depth_m = 12.0;
    const Body body = make_body(c.diver).value();
    double roll_rad = 0.0, off_m = 0.0;
    const auto watch = [&](const HumanState& state) {
      roll_rad = std::max(roll_rad, std::abs(attitude_of(state.root.attitude).roll_rad));
      off_m = std::max(off_m, std::abs(state.root.position_ned_m.z - 12.0));
    };
    using List = std::vector<double>;
    const bool thorough = test::is_thorough();
    for (const double speed_m_s : thorough ? List{0.2, 0.25, 0.3, 0.35} : List{0.2, 0.35}) {
      Swim s = begin(body, {0.0, 0.0, 12.0}, 0.0);
      swim_for(body, s, {{1000.0, 0.0, 12.0}, speed_m_s}, 60.0, watch);
      EXPECT_NEAR(s.state.root.position_ned_m.x / 60.0, speed_m_s, 0.05) << c.name;
      EXPECT_LT(degrees(roll_rad), 10.0) << c.name << " at " << speed_m_s;
    }
    // Hovering, he meets a current.
    for (const double current_m_s : thorough ? List{0.15, 0.2, 0.3} : List{0.15, 0.3}) {
      Swim s = begin(body, {0.0, 0.0, 12.0}, 0.0);
      s.inputs.current_ned_m_s = Vec3(0.0, current_m_s, 0.0);
      swim_for(body, s, {{0.0, 0.0, 12.0}, 0.0}, 90.0, watch);
      EXPECT_LT(degrees(roll_rad), 20.0) << c.name << " in " << current_m_s;
      EXPECT_LT(off_m, 0.6) << c.name;
      EXPECT_LT(glm::length(s.state.root.position_ned_m - Vec3(0.0, 0.0, 12.0)), 3.0) << c.name;
    }
  }
}

// With too much lead, 22 N heavy, he swims up whenever he has sunk.
TEST(Swimmer, WhoIsTooHeavyWithoutAJacketKicksUp) {
  BodyParameters diver;
  diver.gear.jacket.reset();
  diver.gear.lead_kg = 3.0;
  const Body body = make_body(diver).value();
  Swim s = begin(body, {0.0, 0.0, 10.0}, 0.0);
  ASSERT_GT(net_weight_n(body, s.state), 15.0);
  const HoverTrack hover = track_hover(body, s, 10.0, 120.0);
  EXPECT_LT(hover.deepest_m, 15.0);
  EXPECT_LT(s.state.root.position_ned_m.z, 13.0);
}

// Head up, with too much gas in the jacket: the gas lies between the valves until the back is
// straight.
TEST(Swimmer, WhoRisesHeadUpLetsGasOut) {
  const Body body = body_with(Gear{});
  for (const double pitch_deg : {30.0, 40.0, 50.0, 60.0}) {
    Swim s = begin(body, {0.0, 0.0, 18.0}, 0.0);
    s.state.root.attitude = glm::angleAxis(radians(pitch_deg), Vec3(0, 1, 0));
    s.state.life.jacket_moles *= 1.2;
    s.state.life.tanks.moles[0] *= 0.1;
    double highest_m = 18.0;
    swim_for(body, s, {{0.0, 0.0, 20.0}, 0.0}, 60.0, [&](const HumanState& state) {
      highest_m = std::min(highest_m, state.root.position_ned_m.z);
    });
    EXPECT_GT(highest_m, 11.0) << pitch_deg;
  }
}

// Fast enough to right himself, a diver circles round a near place without coming to it.
TEST(Swimmer, WhoIsLevelAgainStopsRightingHimself) {
  const Body body = body_with(Gear{});
  Swim s = begin(body, {0.0, 1.2, 15.0}, 0.0);
  s.swimmer.goes_back = swimming::kRightsHimself;
  int righting = 0, steps = 0;
  swim_for(body, s, {{0.0, 0.0, 15.0}, 0.0}, 30.0, [&](const HumanState&) {
    righting += ++steps > 2400 && s.swimmer.goes_back == swimming::kRightsHimself;
  });
  EXPECT_EQ(righting, 0);
  EXPECT_EQ(s.swimmer.goes_back, 0u);
}

// A standing diver bends into trim, since a kick would carry the diver up.
TEST(Swimmer, WhoStandsTurnsCalmlyIntoTrim) {
  const Body body = body_with(Gear{});
  for (const double depth_m : {5.0, 15.0}) {
    Swim s = begin(body, {0.0, 0.0, depth_m}, 0.0);
    s.state = start_at(body, {0.0, 0.0, depth_m}, glm::angleAxis(0.5 * kPi, Vec3(0, 1, 0)),
                       rotations_of(streamlined(body)));
    const HoverTrack hover = track_hover(body, s, depth_m, 90.0);
    EXPECT_GT(hover.highest_m, depth_m - 1.5) << depth_m;
    EXPECT_LT(hover.deepest_m, depth_m + 1.5) << depth_m;
    EXPECT_LT(hover.rise_m_min, 11.0) << depth_m;
    EXPECT_LT(hover.leaned_s, 60.0) << depth_m;
  }
}

// Nor does one who is to swim on the level kick before he lies: he rose by 5 to 8 m. A way up is
// begun at once.
TEST(Swimmer, WhoStandsLiesDownBeforeHeSwims) {
  const Body body = body_with(Gear{});
  for (const double heading_deg : {0.0, 90.0, 180.0}) {
    const auto stand = [&] {
      Swim s = begin(body, {0.0, 0.0, 12.0}, 0.0);
      s.state = start_at(body, {0.0, 0.0, 12.0},
                         glm::angleAxis(radians(heading_deg), Vec3(0, 0, 1)) *
                             glm::angleAxis(0.5 * kPi, Vec3(0, 1, 0)),
                         rotations_of(streamlined(body)));
      return s;
    };
    Swim level = stand();
    double highest_m = 100.0, deepest_m = 0.0;
    swim_for(body, level, {{60.0, 0.0, 12.0}, 0.45}, 80.0, [&](const HumanState& state) {
      highest_m = std::min(highest_m, state.root.position_ned_m.z);
      deepest_m = std::max(deepest_m, state.root.position_ned_m.z);
    });
    EXPECT_GT(highest_m, 10.7) << heading_deg;
    EXPECT_LT(deepest_m, 13.3) << heading_deg;
    EXPECT_GT(level.state.root.position_ned_m.x, 12.0) << heading_deg;
    Swim up = stand();
    swim_for(body, up, {{0.5, 0.0, 6.0}, 0.45}, 20.0, [](const HumanState&) {});
    EXPECT_LT(up.state.root.position_ned_m.z, 11.0) << heading_deg;
  }
}

// A diver who hovers in a current returns slowly: a place 2.4 m beside moves no faster than a
// vehicle that keeps there flies, and three metres of drift are left alone.
TEST(Swimmer, ComesBackNoFasterThanWhoKeepsBesideCanFollow) {
  const Body body = body_with(Gear{});
  for (const Vec3& current_m_s : {Vec3(0.085, 0.02, 0.0), Vec3(-0.11, 0.0, 0.0)}) {
    Swim s = begin(body, {-12.0, 0.0, 14.4}, 0.0);
    s.inputs.current_ned_m_s = current_m_s;
    swim_for(body, s, {{0.0, 0.0, 14.4}, 0.4}, 28.0, [](const HumanState&) {});
    std::vector<Vec3> beside;  // each two seconds
    double away_m = 0.0;
    int steps = 0;
    const double seconds = test::is_thorough() ? 480.0 : 240.0;
    swim_for(body, s, {{0.0, 0.0, 14.4}, 0.0}, seconds, [&](const HumanState& state) {
      const Vec3& p = state.root.position_ned_m;
      const double heading = attitude_of(state.root.attitude).heading_rad;
      if (steps++ % 480 == 0)
        beside.push_back(p + 2.4 * Vec3(-std::sin(heading), std::cos(heading), 0.0));
      if (steps > 60 * 240) away_m = std::max(away_m, std::hypot(p.x, p.y));
    });
    double fastest_m_s = 0.0;
    for (std::size_t i = 1; i < beside.size(); ++i)
      fastest_m_s = std::max(fastest_m_s, glm::distance(beside[i], beside[i - 1]) / 2.0);
    EXPECT_LT(fastest_m_s, 0.8) << current_m_s.y;
    EXPECT_LT(away_m, 4.5) << current_m_s.y;
  }
}

}  // namespace
}  // namespace neritic::diver
