// Writes what a frame gave, in the layout of the file contract: DIR/frame_0000/SENSOR/...
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "engine/core/result.hpp"
#include "sonar/write_sonar.hpp"
#include "testbed/output/datasets.hpp"
#include "testbed/sensors/session.hpp"

namespace neritic::testbed {

// The content of meta.json besides the view itself.
struct FrameFacts {
  double time_s = 0.0;
  std::uint64_t seed = 0;
  std::string scene, device;
  std::vector<gpu::PassTime> passes;
  double frame_ms = 0.0;
};

// The form of a view's and a sonar's arrays.
enum class Packing {
  kNone,  // .npy
  kNpz,   // compressed: .npz
  // As .png of 16 bits: labels, instances; depth in mm, 0 where nothing is, 65535 beyond 65.534 m;
  // normals as colours. meta.json says how. Other arrays as .npz.
  kPng,
};
// The data of a frame that are written, and how.
struct FrameFormat {
  Datasets datasets = Datasets::all();
  Packing packing = Packing::kNone;
};

// "frame_0000" of OUT.
std::string frame_folder(std::uint32_t number);
// The path in a frame's folder: SENSOR, for a sonar with several heads SENSOR/HEAD.
std::filesystem::path sonar_folder(const SonarFrame& frame);

// Those of depth, normals, labels, instances, and for a camera color.png and motion, that the
// format names and the view has; meta.json.
Status write_view(const std::filesystem::path& folder, const ViewImages& view,
                  const FrameFacts& facts, const FrameFormat& format = {});

// The part of the frame that sonar::write_sonar draws and writes; borrows from the frame.
sonar::SonarFiles sonar_files(const SonarFrame& frame);
// The files of sonar::write_sonar if it was heard, and the sonar's view beside them (in sector_0,
// sector_1, ... if the wedge needed several views).
Status write_sonar_frame(const std::filesystem::path& folder, const SonarFrame& frame,
                         const FrameFacts& facts, const FrameFormat& format = {});

}  // namespace neritic::testbed
