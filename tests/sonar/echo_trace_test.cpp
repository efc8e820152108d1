#include "sonar/echo_trace.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

#include "engine/core/files.hpp"
#include "engine/core/math.hpp"
#include "engine/core/npy.hpp"
#include "engine/scene/image_file.hpp"
#include "sonar/acoustics_pulse.hpp"
#include "tests/support/support.hpp"

namespace neritic {
namespace {

using sonar::EchoTrace;
using sonar::EchoTraceOptions;

// The echo of a flat bottom h below a cone of semi-angle psi: of the cone's solid angle, the
// part between ranges r1 and r2 is proportional to h/r1 - h/r2, its cosine of incidence h/r; hence
// per bin the integral of (h/r) d(-h/r) = (h/r1)^2 - (h/r2)^2, over 2.
std::vector<float> cone_profile(const EchoTraceOptions& o, double h, double psi_rad) {
  std::vector<float> out(o.n_range);
  const double end = h / std::cos(psi_rad);
  for (std::uint32_t i = 0; i < o.n_range; ++i) {
    const double r1 = std::clamp(o.range_min_m + i * o.range_step_m(), h, end),
                 r2 = std::clamp(o.range_min_m + (i + 1) * o.range_step_m(), h, end);
    out[i] = static_cast<float>(0.5 * h * h * (1.0 / (r1 * r1) - 1.0 / (r2 * r2)));
  }
  return out;
}

// The published experiment: down on the seabed at 5 m/min.
EchoTrace descent(double psi_rad) {
  EchoTrace trace({.n_range = 500, .range_min_m = 0.2, .range_max_m = 12.0});
  for (int i = 0; i <= 120; ++i) {
    const double depth = 2.0 + 5.0 / 60.0 * i;
    trace.append(cone_profile(trace.options(), 13.0 - depth, psi_rad), i, depth);
  }
  return trace;
}

TEST(EchoTrace, ADescentAtFiveMetresAMinuteHasThatSlopeAndItsDepthAtEveryPing) {
  for (const double psi_deg : {1.0, 5.0, 15.0}) {
    const EchoTrace trace = descent(radians(psi_deg));
    const auto fit = trace.first_return_slope();
    ASSERT_TRUE(fit);
    EXPECT_EQ(fit->count, 121u);
    EXPECT_NEAR(fit->slope, -5.0 / 60.0, 0.005 * 5.0 / 60.0);
    const double bin = trace.options().range_step_m();
    for (const auto& ping : trace.pings()) {
      EXPECT_NEAR(ping.first_depth_m(), 13.0, bin) << psi_deg << " deg at " << ping.time_s;
      EXPECT_NEAR(ping.strongest_depth_m(), 13.0, bin) << psi_deg << " deg";
    }
    if (psi_deg == 15.0) {  // a long echo shows where in the first bin it begins
      EXPECT_LT(fit->rms, 0.1 * bin);
    }
  }
}

TEST(EchoTrace, TheLeadingEdgeIsFoundWithinItsBin) {
  const auto edge = [](std::vector<float> profile) {
    return sonar::first_return_bins(profile, 0.2, 0.0);
  };
  EXPECT_NEAR(*edge({0, 0, 0.25f, 1, 1, 1}), 2.75, 1e-6);
  EXPECT_NEAR(*edge({0, 0, 1, 1, 1}), 2.0, 1e-6);
  EXPECT_NEAR(*edge({0, 0.1f, 1, 1, 1}), 1.9, 1e-6);  // the part is below the threshold
  EXPECT_NEAR(*edge({0, 0, 1, 0, 0}), 2.5, 1e-6);
  EXPECT_NEAR(*edge({0.3f, 1, 1}), 0.7, 1e-6);
  EXPECT_NEAR(*edge({0, 0, 1}), 2.5, 1e-6);
  EXPECT_FALSE(edge({0, 0, 0}));
  EXPECT_FALSE(edge({}));
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_NEAR(*edge({nan, -3, 1, nan}), 2.5, 1e-6);
  EXPECT_FALSE(sonar::first_return_bins(std::vector<float>{0, 0.5f, 0}, 0.2, 0.5));
}

// The same bottom through a pulse that is longer than a bin: the edge that it draws out has its
// middle where the bottom is, and a cone so narrow that the bottom is a point has its peak there.
TEST(EchoTrace, ThePulseMovesNoBottom) {
  EchoTraceOptions o{.n_range = 500, .range_min_m = 0.2, .range_max_m = 12.0};
  const auto kernel = sonar::range_spread(sonar::PulseShape::kHann, 0.05, o.range_step_m());
  ASSERT_TRUE(kernel.ok());
  o.pulse_bins = 1.0 / kernel->energy[kernel->reach];
  EXPECT_GT(o.pulse_bins, 2.0);
  const int reach = static_cast<int>(kernel->reach);
  for (const double psi_deg : {0.5, 5.0, 12.5}) {
    EchoTrace trace(o);
    for (int i = 0; i < 200; ++i) {
      const auto profile = cone_profile(o, 4.0 + 0.0173 * i, radians(psi_deg));
      std::vector<float> heard(o.n_range);
      for (int row = reach; row < 500 - reach; ++row)
        for (int k = -reach; k <= reach; ++k)
          heard[static_cast<std::size_t>(row)] +=
              static_cast<float>(kernel->energy[static_cast<std::size_t>(k + reach)]) *
              profile[static_cast<std::size_t>(row + k)];
      trace.append(heard, i, 0.0);
      const double bins = psi_deg > 1.0 ? std::max(1.0, 0.7 * o.pulse_bins) : 1.0;
      const auto& ping = trace.pings().back();
      EXPECT_NEAR(ping.first_m, 4.0 + 0.0173 * i, bins * o.range_step_m()) << psi_deg;
      EXPECT_NEAR(ping.strongest_m, 4.0 + 0.0173 * i, bins * o.range_step_m()) << psi_deg;
    }
  }
}

TEST(EchoTrace, FirstAndStrongestAreToldApart) {
  EchoTrace trace({.n_range = 100, .range_min_m = 0.0, .range_max_m = 10.0});
  std::vector<float> profile(100);
  profile[30] = 0.5f;  // a shoal of fish over the bottom
  profile[70] = 1.0f;
  profile[71] = 1.0f;
  trace.append(profile, 0.0, 4.0);
  trace.append(std::vector<float>(100), 1.0, 4.0);
  EXPECT_NEAR(trace.pings()[0].first_depth_m(), 4.0 + 3.05, 1e-9);
  EXPECT_NEAR(trace.pings()[0].strongest_depth_m(), 4.0 + 7.0, 1e-9);  // where it begins
  EXPECT_TRUE(std::isnan(trace.pings()[1].first_m));
  EXPECT_TRUE(std::isnan(trace.pings()[1].strongest_m));
  EXPECT_FALSE(trace.first_return_slope());
}

TEST(EchoTrace, ALineIsFittedThroughWhatIsThere) {
  const double nan = std::nan("");
  const std::vector<double> x{0, 1, 2, 3, nan, 5}, y{1, 3, nan, 7, 2, 11};
  const auto fit = sonar::fit_line(x, y);
  ASSERT_TRUE(fit);
  EXPECT_EQ(fit->count, 4u);
  EXPECT_NEAR(fit->slope, 2.0, 1e-12);
  EXPECT_NEAR(fit->at_zero, 1.0, 1e-12);
  EXPECT_NEAR(fit->rms, 0.0, 1e-12);
  const std::vector<double> same{2, 2, 2};
  EXPECT_FALSE(sonar::fit_line(same, same));
  const std::vector<double> far{1e12, 1e12 + 1, 1e12 + 2}, up{5, 6, 8};
  EXPECT_NEAR(sonar::fit_line(far, up)->slope, 1.5, 1e-9);
}

TEST(EchoTrace, FilesHoldTheTraceAndThePictureIsDrawn) {
  EchoTrace trace({.n_range = 400, .range_min_m = 0.2, .range_max_m = 12.0});
  std::mt19937 random(5);
  std::exponential_distribution<float> speckle(1.0f);
  for (int i = 0; i < 240; ++i) {  // over a bank, with speckle, noise and fish
    const double h = 8.0 - 2.5 * std::exp(-std::pow((i - 120.0) / 35.0, 2.0));
    auto profile = cone_profile(trace.options(), h, radians(12));
    for (auto& v : profile) v = v * speckle(random) + 2e-6f * speckle(random);
    if (std::abs(i - 60) < 14)
      for (int k = 0; k < 8; ++k)
        profile[100 + k + std::abs(i - 60) / 2] += 1e-3f * speckle(random);
    trace.append(profile, 0.5 * i, 1.0);
  }
  const test::ScratchFolder folder;
  ASSERT_TRUE(sonar::write_echo_trace(folder.path(), trace, {{"seed", 5}}).ok());
  const NpyArray array = read_npy(folder / "echo_trace.npy").value();
  EXPECT_EQ(array.shape, (std::vector<std::size_t>{240, 400}));
  const std::string csv = read_text(folder / "echo_trace.csv").value();
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 241);
  const auto json = nlohmann::json::parse(read_text(folder / "echo_trace.json").value());
  EXPECT_EQ(json["pings"], 240);
  EXPECT_TRUE(json.contains("first_return_fit"));
  if (const char* keep = std::getenv("NERITIC_KEEP_PICTURES")) {
    std::filesystem::copy(folder / "echo_trace.png", std::filesystem::path(keep) / "echo_trace.png",
                          std::filesystem::copy_options::overwrite_existing);
    ASSERT_TRUE(scene::write_png8(std::filesystem::path(keep) / "echo_descent.png",
                                  sonar::draw_echo_trace(descent(radians(15))))
                    .ok());
  }
}

TEST(EchoTrace, NothingHeardIsDrawnToo) {
  EchoTrace trace({.n_range = 10, .range_min_m = 0.0, .range_max_m = 1.0});
  EXPECT_EQ(sonar::draw_echo_trace(trace, {.height_px = 300, .width_px = 400}).width, 400u);
  trace.append(std::vector<float>(10), 0.0, 0.0);
  EXPECT_EQ(sonar::draw_echo_trace(trace, {.height_px = 300, .width_px = 400}).width, 400u);
  const test::ScratchFolder folder;
  EXPECT_TRUE(sonar::write_echo_trace(folder.path(), trace, {}).ok());
}

TEST(EchoTrace, OptionsThatCannotBeAreNamed) {
  EXPECT_TRUE(sonar::validate(EchoTraceOptions{}).ok());
  for (const EchoTraceOptions& bad :
       {EchoTraceOptions{.n_range = 0}, EchoTraceOptions{.range_min_m = 60},
        EchoTraceOptions{.relative_threshold = 2}, EchoTraceOptions{.floor = -1},
        EchoTraceOptions{.floor_by_bin = {1.0f}}, EchoTraceOptions{.pulse_bins = 0.5}}) {
    const Status status = sonar::validate(bad);
    ASSERT_FALSE(status.ok());
    EXPECT_NE(status.error().message.find("accepted"), std::string::npos);
  }
}

}  // namespace
}  // namespace neritic
