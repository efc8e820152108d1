// A sheet without thickness, open at its rim: what happens to a vehicle that meets it, and to one
// that was put half way through.
#include <algorithm>

#include "tests/testbed/simulation/senders.hpp"

namespace neritic::testbed {
namespace {

// 3 m by 3 m, upright across the way east at x = 1.5 m.
std::string sheet_text(const std::string& more) {
  return std::string("[physics]\n") +
         "[[objects]]\nname = \"sheet\"\nclass = \"structure\"\nshape = \"plane\"\n"
         "size_m = [3, 3]\nposition_m = [1.5, -10, 0]\nroll_deg = 90\n" +
         rov_text(more);
}

void push(TestDive& dive, double surge_n, double sway_n = 0.0) {
  Piloting inputs;
  inputs.piloted = 1;
  inputs.pilot[0] = surge_n;
  inputs.pilot[1] = sway_n;
  pilot(dive, 0, inputs);
}

// From either side, at its face: it stops there, and gets off again.
TEST(ThinPlane, StopsFromBothSidesAndLetsGo) {
  for (const double side : {-1.0, 1.0}) {
    TestDive dive = dive_of(sheet_text(
        fmt::format("position_m = [{}, -10, 0]\nyaw_deg = {}\n", 1.5 + side, 90.0 * side)));
    push(dive, 200.0);
    dive.run(20.0, [&] { ASSERT_GT(side * (dive.pose().position_m.x - 1.5), 0.1); });
    EXPECT_GT(dive.vehicle().contact.touched_steps, 100u);
    EXPECT_LT(dive.vehicle().contact.deepest_m, 0.006);
    push(dive, -60.0);
    dive.run(6.0);
    EXPECT_GT(side * (dive.pose().position_m.x - 1.5), 0.8);
  }
}

// Along it and against its rim, nose first: it does not get through, and gets off again.
TEST(ThinPlane, ItsRimStopsToo) {
  TestDive dive = dive_of(sheet_text("position_m = [1.52, -10, 2.5]\n"));  // north: at the edge
  push(dive, 200.0);
  dive.run(20.0, [&] { ASSERT_LT(dive.speed_m_s(), 4.0); });
  EXPECT_GT(dive.vehicle().contact.touched_steps, 10u);
  EXPECT_LT(dive.vehicle().contact.deepest_m, 0.006);
  EXPECT_EQ(dive.simulation->refused_states(), 0u);
}

// A scene cannot start there, but a state can be set so, the sheet through the middle of its parts:
// it is led out to one side, and flies away from there.
TEST(ThinPlane, WhoWasPutThroughItIsLedOutAndFliesOn) {
  for (const double along_m : {0.0, 1.45})  // the middle; the rim
    for (const double off_m : {-0.05, 0.0, 0.02, 0.1}) {
      TestDive dive = dive_of(sheet_text("position_m = [-3, -10, 0]\nyaw_deg = -90\n"));
      PhysicsState state = dive.world->start();
      PhysicsInputs inputs = dive.world->start_inputs();
      rov::State& body = state.vehicles()[0].body;
      ASSERT_TRUE(rov::teleport(body, rov::ned_from_world(Vec3(1.5 + off_m, -10.0, along_m)),
                                body.attitude));
      long step = 0;
      const auto x_after = [&](double seconds, double surge_n) {
        inputs.vehicles()[0] = held({.piloted = 1});
        inputs.vehicles()[0].wrench.wrench[0] = surge_n;
        for (const auto end = step + std::lround(seconds * 240); step < end; ++step) {
          state = dive.world->step(state, inputs, {std::uint64_t(step), dive.world->step_s()});
          EXPECT_TRUE(sim::all_finite(state));
          EXPECT_LT(glm::length(body.velocity.linear()), 2.0);
        }
        return rov::world_from_ned(body.position_ned_m).x;
      };
      const double rest_x = x_after(5.0, 0.0);
      EXPECT_GT(std::abs(rest_x - 1.5), 0.2) << along_m << " " << off_m;
      const double away = rest_x > 1.5 ? 1.0 : -1.0;
      EXPECT_GT(away * (x_after(10.0, away * 60.0) - rest_x), 3.0) << along_m << " " << off_m;
    }
}

}  // namespace
}  // namespace neritic::testbed
