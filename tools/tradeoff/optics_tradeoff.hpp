// `neritic tradeoff optics`: what the water's optics cost over their error against brute force on
// the CPU, in double: a lamp's inscatter along a sight by its samples, caustics by the texels of
// their tile, forward scatter by its octaves, light shafts by their samples, skylight by its cells,
// colours by the bands of the spectrum. One thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "engine/core/result.hpp"

namespace neritic::tools {

struct OpticsTradeoffOptions {
  std::string device;
  bool quick = false;                  // coarser truths, few settings
  std::function<void()> step = [] {};  // after each of steps(options)
};
std::uint64_t steps(const OpticsTradeoffOptions& options);

struct OpticsPoint {
  // "inscatter", "caustics", "forward scatter", "light shafts", "skylight", "bands"
  std::string term;
  std::uint32_t value = 0;  // samples, texels a side, octaves, centimetres a cell, bands
  double error = 0.0;       // root mean square, relative; contrast, CIEDE2000 of bands: largest
  double ms = 0.0;  // of the device: a megapixel; of caustics: a frame's tile; of skylight: once
};

struct OpticsTradeoff {
  std::string device;
  std::vector<OpticsPoint> points;
};
Result<OpticsTradeoff> run_optics_tradeoff(const OpticsTradeoffOptions& options);

// Writes optics.csv, .md, .json and .plot.json into the folder. True: optics.png was drawn too.
Result<bool> write_optics_tradeoff(const std::filesystem::path& folder,
                                   const OpticsTradeoff& tradeoff);

}  // namespace neritic::tools
