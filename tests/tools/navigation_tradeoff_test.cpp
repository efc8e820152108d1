// `neritic tradeoff navigation`: what its curves say, and its files.
#include "tools/tradeoff/navigation_tradeoff.hpp"

#include <gtest/gtest.h>

#include "engine/core/files.hpp"
#include "tests/support/support.hpp"

namespace neritic::tools {
namespace {

TEST(NavigationTradeoff, ErrorsAreThoseOfTheAids) {
  NavigationTradeoffOptions options;
  options.vehicle = test::source_dir() / "assets/vehicles/bluerov2_heavy_survey_dynamics.toml";
  options.quick = true;
  std::uint64_t taken = 0;
  options.step = [&] { ++taken; };
  const auto t = run_navigation_tradeoff(options);
  ASSERT_TRUE(t.ok()) << t.error().message;
  EXPECT_EQ(taken, steps(options));
  EXPECT_NEAR(t->way_m, 0.5 * t->flight_s, 0.1 * t->flight_s);
  const auto point = [&](const std::string& aids, const std::string& sweep, double rate_hz) {
    for (const NavigationPoint& p : t->points)
      if (p.aids == aids && p.sweep == sweep && p.rate_hz == rate_hz) return p;
    ADD_FAILURE() << aids << " " << sweep << " " << rate_hz;
    return NavigationPoint{};
  };
  for (const NavigationPoint& p : t->points) {
    EXPECT_GT(p.error_m, 0.01) << p.aids << p.rate_hz;
    if (p.sweep == "dvl" || p.rate_hz >= 25.0) {
      EXPECT_LT(p.error_m, p.aids == "USBL" ? 3.0 : 1.0) << p.aids << p.rate_hz;
    }
    EXPECT_LT(p.error_deg, 6.0) << p.aids << p.rate_hz;
    EXPECT_GT(p.us_a_second, 0.0);
  }
  // Means since the last sample miss no turn: ten a second do where a DVL corrects.
  EXPECT_LT(point("DVL", "imu", 10).error_m, 2.0 * point("DVL", "imu", 200).error_m);
  EXPECT_TRUE(point("DVL", "imu", 200).is_file);
  EXPECT_FALSE(point("DVL", "imu", 100).is_file);
  // One setting in two sweeps is one error.
  EXPECT_EQ(point("DVL", "imu", 200).error_m, point("DVL", "dvl", 8).error_m);
  EXPECT_LT(point("DVL and USBL", "dvl", 8).error_m, point("USBL", "imu", 200).error_m);

  const test::ScratchFolder scratch;
  ASSERT_TRUE(write_navigation_tradeoff(scratch / "out", *t).ok());
  const std::string csv = read_text(scratch / "out" / "navigation.csv").value();
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), std::ptrdiff_t(t->points.size()) + 1);
  EXPECT_NE(read_text(scratch / "out" / "navigation.md").value().find("| DVL | 200 (file) |"),
            std::string::npos);
}

}  // namespace
}  // namespace neritic::tools
