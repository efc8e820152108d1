// A swimmer whose depth a person steers: the rate that is asked within seconds, and a stop within
// seconds of letting go.
#include <gtest/gtest.h>

#include "tests/diver/swims.hpp"
#include "tests/support/support.hpp"

namespace neritic::diver {
namespace {

struct Steered {
  double soon_m_s = 0.0;    // mean rate along the way from the 2nd to the 5th second
  double rate_m_s = 0.0;    // from the 4th to the 10th
  double stops_m = 0.0;     // from where it was let go of to where it rests
  double off_m = 0.0;       // then from there at most, within half a minute, or one (thorough)
  double most_rad_s = 0.0;  // the body's turning
};

// From a hover at that depth, or a swim.
Steered steer(const Body& body, Swim s, double depth_m, double climb_m_s, bool ahead) {
  Steered out;
  const auto nothing = [](const HumanState&) {};
  const auto place = [&] { return s.state.root.position_ned_m; };
  if (ahead) swim_for(body, s, {{100.0, 0.0, depth_m}, 0.5}, 15.0, nothing);
  const double begin_m = place().z, way = std::copysign(1.0, climb_m_s);
  const auto seen = [&](const HumanState& state) {
    out.most_rad_s = std::max(out.most_rad_s, glm::length(state.root.velocity.angular()));
  };
  std::array<double, 11> depths_m{begin_m};
  for (std::size_t second = 1; second < depths_m.size(); ++second) {
    for (int i = 0; i < 4; ++i) {
      const Vec3 to = place() + Vec3(4.0, 0.0, -3.0 * way);
      swim_for(body, s, {to, std::abs(climb_m_s) > 0.2 ? 0.68 : 0.5, climb_m_s}, 0.25, seen);
    }
    depths_m[second] = place().z;
  }
  out.soon_m_s = way * (depths_m[2] - depths_m[5]) / 3.0;
  out.rate_m_s = way * (depths_m[4] - depths_m[10]) / 6.0;
  Vec3 stays = place();
  for (int i = 0; i < 5; ++i) {
    swim_for(body, s, {stays, 0.0, 0.0}, 0.5, seen);
    stays.z = place().z;
  }
  out.stops_m = way * (depths_m.back() - stays.z);
  swim_for(body, s, {stays, 0.0}, test::is_thorough() ? 60.0 : 30.0, [&](const HumanState& state) {
    seen(state);
    out.off_m = std::max(out.off_m, std::abs(state.root.position_ned_m.z - stays.z));
  });
  return out;
}

void expect_steered(const Steered& s, double climb_m_s) {
  const double asked_m_s = std::abs(climb_m_s);
  EXPECT_NEAR(s.rate_m_s, asked_m_s, 0.25 * asked_m_s);
  EXPECT_GT(s.stops_m, 0.0);
  EXPECT_LT(s.stops_m, 2.5 * asked_m_s);
  EXPECT_GT(s.soon_m_s, 0.35 * asked_m_s);
  EXPECT_LT(s.off_m, 0.4);
  EXPECT_LT(s.most_rad_s, 1.5);
}

TEST(Swimmer, GoesUpAndDownAtTheRateThatAPersonAsks) {
  const Body body = body_with(Gear{});
  for (const double depth_m : {5.0, 12.0, 30.0}) {
    Swim hover = begin(body, {0.0, 0.0, depth_m}, 0.0);
    swim_for(body, hover, {{0.0, 0.0, depth_m}, 0.0}, 120.0, [](const HumanState&) {});
    for (const double climb_m_s : {0.15, -0.15, 0.25, -0.25})
      for (const bool ahead : {false, true}) {
        if (depth_m < 6.0 && climb_m_s > 0.2) continue;  // it would reach the surface
        SCOPED_TRACE(testing::Message() << depth_m << " m, " << climb_m_s << " m/s, " << ahead);
        expect_steered(steer(body, hover, depth_m, climb_m_s, ahead), climb_m_s);
      }
  }
}

}  // namespace
}  // namespace neritic::diver
