// `neritic tradeoff xr`: what a headset's pictures cost and how wrong they are, over resolution,
// number of views and foveation, against both eyes at full resolution; and how late an instrument
// is over the rate at which it is drawn. One thread.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "engine/core/image.hpp"
#include "engine/core/math.hpp"
#include "engine/core/result.hpp"

namespace neritic::tools {

struct XrTradeoffOptions {
  std::string scene = "assets/scenes/dive.toml", device;
  bool quick = false;                  // small pictures, few settings: to see that it works
  std::function<void()> step = [] {};  // after each of steps(options)
};
std::uint64_t steps(const XrTradeoffOptions& options);

struct XrPoint {
  std::string views;       // "one", "two", "four"
  double scale = 1.0;      // of the (wide) views' resolution, linear
  double focus_deg = 0.0;  // half the angle of the sharp views; 0: none
  double mpixels = 0.0;    // shaded, of all views
  double ms = 0.0;         // of the device's passes
  // In sRGB levels of 255, root mean square over both eyes: plain, and weighted by the eye's acuity
  // around the middle.
  double error = 0.0, fovea_error = 0.0;
};

struct HudRatePoint {
  double rate_hz = 0.0;
  double late_m = 0.0;       // the farthest that the shown depth is off, at 18 m a minute
  double ms_a_second = 0.0;  // of one core
};

struct XrTradeoff {
  std::string device;
  std::uint32_t side_px = 0;  // of each eye at full resolution
  std::vector<XrPoint> points;
  std::vector<HudRatePoint> hud;
};
Result<XrTradeoff> run_xr_tradeoff(const XrTradeoffOptions& options);

// The part of a picture's error that the eye weighs at an angle from where it looks: acuity
// falls as 1 / (1 + e / 2.3 degrees) (Levi, Klein and Aitsebaomo 1985, Vision Res. 25, 963: E2 of
// resolution 2.3 to 3), squared for an area.
double acuity_weight(double eccentricity_deg);
// Two pictures of one view: root mean square of the levels' differences.
double weighted_error(const ImageU8& shown, const ImageU8& wanted, const FrustumTangents& view,
                      bool weighted);

// Writes xr.csv, .md, .json and .plot.json into the folder. True: xr.png was drawn too.
Result<bool> write_xr_tradeoff(const std::filesystem::path& folder, const XrTradeoff& tradeoff);

}  // namespace neritic::tools
