#include "sonar/sidescan.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "engine/core/files.hpp"
#include "engine/core/npy.hpp"
#include "engine/scene/image_file.hpp"
#include "tests/support/support.hpp"

namespace neritic {
namespace {

using sonar::SidescanOptions;
using sonar::SidescanRecord;

Pose at(double along_m) {
  return {Vec3(0, -5, -along_m), Quat(1, 0, 0, 0)};
}

// Energy of a flat bottom h below: uniform a metre of ground, from h on.
std::vector<float> flat_side(const SidescanOptions& o, double h) {
  std::vector<float> out(o.n_range);
  for (std::uint32_t i = 0; i < o.n_range; ++i) {
    const double r0 = std::max(h, o.range_min_m + i * o.range_step_m()),
                 r1 = std::max(h, o.range_min_m + (i + 1) * o.range_step_m());
    out[i] = static_cast<float>(std::sqrt(r1 * r1 - h * h) - std::sqrt(r0 * r0 - h * h));
  }
  return out;
}

TEST(Sidescan, PortIsReversedAtTheLeft) {
  SidescanRecord record({.n_range = 3});
  const std::vector<float> port{1, 2, 3}, starboard{4, 5, -6};
  record.append(port, starboard, at(0), 0.0);
  EXPECT_EQ(std::vector<float>(record.slant_image().begin(), record.slant_image().end()),
            (std::vector<float>{3, 2, 1, 4, 5, 0}));
}

TEST(Sidescan, TheAltitudeIsTrackedWithinABinAndAFishDoesNotMoveIt) {
  const SidescanOptions options{.n_range = 400, .range_min_m = 1.0, .range_max_m = 41.0};
  SidescanRecord record(options);
  std::vector<double> truth;
  for (int i = 0; i < 60; ++i) {
    truth.push_back(6.0 + 0.02 * i);
    auto side = flat_side(options, truth.back());
    if (i % 20 == 7) side[20] = 5.0f;  // in the water column
    record.append(side, side, at(i), i);
  }
  const auto altitude = record.first_returns().altitude_m();
  for (std::size_t i = 0; i < truth.size(); ++i)
    EXPECT_NEAR(altitude[i], truth[i], options.range_step_m()) << i;
  SidescanRecord silent(options);
  silent.append(std::vector<float>(400), std::vector<float>(400), at(0), 0);
  EXPECT_TRUE(std::isnan(silent.first_returns().altitude_m()[0]));
}

TEST(Sidescan, EachSideTracksItsOwnBottom) {
  const SidescanOptions options{.n_range = 400, .range_min_m = 1.0, .range_max_m = 41.0};
  SidescanRecord record(options);
  const auto port = flat_side(options, 8.0), starboard = flat_side(options, 11.0);
  for (int i = 0; i < 5; ++i) record.append(port, starboard, at(i), i);
  record.append(std::vector<float>(400), starboard, at(5), 5);
  const auto bottom = record.first_returns();
  for (int i = 0; i < 5; ++i) {
    EXPECT_NEAR(bottom.port_m[i], 8.0, options.range_step_m());
    EXPECT_NEAR(bottom.starboard_m[i], 11.0, options.range_step_m());
    EXPECT_EQ(bottom.altitude_m()[i], bottom.port_m[i]);
  }
  // A side that hears nothing is laid out by the other's.
  const std::vector<double> deaf(6, std::nan(""));
  const auto one = sonar::ground_image(record, {deaf, bottom.starboard_m}, 100);
  const auto both = sonar::ground_image(record, {bottom.starboard_m, bottom.starboard_m}, 100);
  EXPECT_EQ(one.intensity, both.intensity);
}

TEST(Sidescan, WhatLiesBelowTheFloorIsNoBottom) {
  SidescanOptions options{.n_range = 400, .range_min_m = 1.0, .range_max_m = 41.0};
  auto side = flat_side(options, 10.0);
  for (std::size_t i = 0; i < 80; ++i) side[i] += 0.06f;  // noise in the water column
  options.relative_threshold = 0.1;
  SidescanRecord noisy(options);
  noisy.append(side, side, at(0), 0);
  EXPECT_LT(noisy.first_returns().altitude_m()[0], 2.0);
  options.floor_by_bin.assign(400, 0.07f);
  SidescanRecord floored(options);
  floored.append(side, side, at(0), 0);
  EXPECT_NEAR(floored.first_returns().altitude_m()[0], 10.0, options.range_step_m());
}

TEST(Sidescan, AFlatBottomIsEvenInGroundRangeAndKeepsItsEnergy) {
  const SidescanOptions options{.n_range = 500, .range_min_m = 0.0, .range_max_m = 50.0};
  for (const double h : {0.0, 4.0, 10.03}) {
    SidescanRecord record(options);
    const auto side = flat_side(options, h);
    record.append(side, side, at(0), 0.0);
    const std::vector<double> altitude{h};
    const auto ground = sonar::ground_image(record, {altitude, altitude}, 100);
    ASSERT_EQ(ground.intensity.size(), 200u);
    double slant_sum = 0.0, ground_sum = 0.0;
    for (const float v : record.slant_image()) slant_sum += v;
    for (const float v : ground.intensity) ground_sum += v;
    EXPECT_NEAR(ground_sum, slant_sum, 1e-5 * slant_sum) << h;
    const double reach = std::sqrt(50.0 * 50.0 - h * h);
    for (std::uint32_t k = 0; k < 100; ++k) {
      EXPECT_EQ(ground.intensity[100 + k], ground.intensity[99 - k]);
      // 0.5 m a bin. Next to nadir a slant bin spans metres of ground, in which range tells
      // nothing.
      if ((k + 1) * 0.5 < reach && k > 8) {
        EXPECT_NEAR(ground.intensity[100 + k], 0.5, 0.02) << h << " bin " << k;
      } else if (k * 0.5 > reach) {
        EXPECT_EQ(ground.intensity[100 + k], 0.0f);
      }
    }
  }
}

TEST(Sidescan, AnObjectLandsAtItsGroundRange) {
  const SidescanOptions options{.n_range = 1000, .range_min_m = 0.0, .range_max_m = 50.0};
  SidescanRecord record(options);
  std::vector<float> starboard(1000), port(1000);
  const double h = 12.0, g = 30.0;
  starboard[static_cast<std::size_t>(std::hypot(h, g) / 0.05)] = 1.0f;
  record.append(port, starboard, at(0), 0.0);
  const std::vector<double> altitude{h};
  const auto ground = sonar::ground_image(record, {altitude, altitude}, 500);
  for (std::size_t k = 0; k < 1000; ++k)
    if (ground.intensity[k] > 0.0f) {
      EXPECT_NEAR((static_cast<double>(k) - 500 + 0.5) * 0.1, g, 0.15);
    }
  const std::vector<double> unknown{std::nan("")};
  EXPECT_TRUE(std::isnan(sonar::ground_image(record, {unknown, unknown}, 500).intensity[3]));
}

// A seabed with ripples, a wreck that stands up and its shadow, rocks; speckle; a bank.
SidescanRecord survey() {
  const SidescanOptions options{.n_range = 600, .range_min_m = 0.0, .range_max_m = 40.0};
  SidescanRecord record(options);
  std::mt19937 random(2);
  std::exponential_distribution<double> speckle(1.0);
  double along = 0.0;
  for (int ping = 0; ping < 500; ++ping) {
    along += ping < 250 ? 0.10 : 0.16;  // the boat speeds up
    const double h = 7.0 + 1.2 * std::sin(along / 18.0);
    std::vector<float> sides[2];
    for (int s = 0; s < 2; ++s)
      for (std::uint32_t i = 0; i < 600; ++i) {
        const double r = (i + 0.5) * options.range_step_m();
        double v = 2e-4;
        if (r > h) {
          const double g = std::sqrt(r * r - h * h), x = s == 0 ? -g : g;
          v = std::pow(h / r, 1.2) * (1.0 + 0.4 * std::sin(along * 1.5 + 0.8 * x));
          const double u = along - 30.0, w = x - 16.0;
          if (std::abs(u) < 6.0 && std::abs(w - 0.15 * u) < 1.2) v = 3.5;
          if (std::abs(u) < 6.0 && w - 0.15 * u > 1.2 && w - 0.15 * u < 7.0) v = 0.005;
          for (int k = 0; k < 6; ++k) {
            const double du = along - 8.0 * k - 6.0, dw = x + 12.0 + 4.0 * (k % 4);
            if (std::hypot(du, dw) < 0.5) v = 4.0;
            if (std::abs(du) < 0.5 && dw < -0.5 && dw > -2.2) v = 0.01;
          }
        }
        sides[s].push_back(static_cast<float>(v * speckle(random)));
      }
    record.append(sides[0], sides[1], at(along), ping * 0.1);
  }
  return record;
}

TEST(Sidescan, FilesHoldTheRecordAndThePicturesAreDrawn) {
  const SidescanRecord record = survey();
  const test::ScratchFolder folder;
  ASSERT_TRUE(sonar::write_sidescan(folder.path(), record, {{"seed", 2}}).ok());
  EXPECT_EQ(read_npy(folder / "sidescan_slant.npy")->shape, (std::vector<std::size_t>{500, 1200}));
  EXPECT_EQ(read_npy(folder / "sidescan_ground.npy")->shape, (std::vector<std::size_t>{500, 1200}));
  EXPECT_EQ(read_npy(folder / "sidescan_track.npy")->shape, (std::vector<std::size_t>{500, 3}));
  const auto json = nlohmann::json::parse(read_text(folder / "sidescan.json").value());
  EXPECT_NEAR(json["track_length_m"], 250 * 0.1 + 250 * 0.16 - 0.1, 1e-9);
  // True proportion: as many pixels a metre along as across.
  const ImageU8 ground = scene::read_image8(folder / "sidescan_ground.png").value();
  EXPECT_EQ(ground.width, 1200u);
  EXPECT_NEAR(ground.height - 96.0 - 64.0, (1200.0 - 188.0) * 64.9 / 80.0, 2.0);
  if (const char* keep = std::getenv("NERITIC_KEEP_PICTURES"))
    for (const char* name : {"sidescan_slant.png", "sidescan_ground.png"})
      std::filesystem::copy(folder / name, std::filesystem::path(keep) / name,
                            std::filesystem::copy_options::overwrite_existing);
}

TEST(Sidescan, NothingIsDrawnToo) {
  SidescanRecord record({.n_range = 20});
  const sonar::SidescanPictureOptions small{.width_px = 300, .max_height_px = 300};
  const test::ScratchFolder folder;
  EXPECT_TRUE(sonar::write_sidescan(folder.path(), record, {}, small).ok());
  record.append(std::vector<float>(20), std::vector<float>(20), at(0), 0.0);
  EXPECT_TRUE(sonar::write_sidescan(folder.path(), record, {}, small).ok());
  for (int i = 1; i < 3000; ++i)
    record.append(std::vector<float>(20, 1.0f), std::vector<float>(20, 1.0f), at(i), i);
  const auto bottom = record.first_returns();
  EXPECT_LE(sonar::draw_slant(record, bottom, small).height, 320u);
  EXPECT_LE(sonar::draw_ground(record, sonar::ground_image(record, bottom, 20), small).height,
            320u);
}

TEST(Sidescan, OptionsThatCannotBeAreNamed) {
  EXPECT_TRUE(sonar::validate(SidescanOptions{}).ok());
  for (const SidescanOptions& bad :
       {SidescanOptions{.n_range = 0}, SidescanOptions{.range_min_m = 60},
        SidescanOptions{.relative_threshold = 0}, SidescanOptions{.floor = -1},
        SidescanOptions{.floor_by_bin = {1.0f}}, SidescanOptions{.tracking_pings = 4}}) {
    const Status status = sonar::validate(bad);
    ASSERT_FALSE(status.ok());
    EXPECT_NE(status.error().message.find("accepted"), std::string::npos);
  }
}

}  // namespace
}  // namespace neritic
