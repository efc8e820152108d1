// `neritic tradeoff camera`: how far a camera's picture is from the one with every knob of its
// detail at its best, over what it costs, knob by knob and level by level. One thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "engine/core/image.hpp"
#include "engine/core/result.hpp"

namespace neritic::tools {

struct CameraTradeoffOptions {
  std::string scene = "assets/scenes/wreck.toml", device;  // whose first camera it is
  bool quick = false;                                      // small pictures, few repeats
  std::function<void()> step = [] {};                      // after each of steps(options)
};
std::uint64_t steps(const CameraTradeoffOptions& options);

struct CameraPoint {
  std::string knob;  // or "level"
  std::string value;
  double ms = 0.0;     // of the device's passes, the least of several
  double error = 0.0;  // root mean square, 1 from black to white
  double flip = 0.0;   // flip_error, 0 to 1
};

struct CameraTradeoff {
  std::string device, scene, camera;
  std::uint32_t width = 0, height = 0;
  std::vector<CameraPoint> points;
};
Result<CameraTradeoff> run_camera_tradeoff(const CameraTradeoffOptions& options);

// The difference of two pictures of one size, in sRGB.
double rms_error(const ImageU8& shown, const ImageU8& wanted);
// Writes camera.csv, .md, .json and .plot.json into the folder. True: camera.png was drawn too.
Result<bool> write_camera_tradeoff(const std::filesystem::path& folder,
                                   const CameraTradeoff& tradeoff);

}  // namespace neritic::tools
