// A mechanically scanned single beam: one profile a step of the head, while the vehicle moves. Two
// pictures of it: as the device shows it, which knows the head's angle only, and put together in
// the world from each step's pose. Intensities are linear. One owner, one thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "engine/core/image.hpp"
#include "engine/core/math.hpp"
#include "engine/core/result.hpp"
#include "sonar/reference.hpp"

namespace neritic::sonar {

struct MechanicalScanOptions {
  std::uint32_t n_range = 500;
  double range_min_m = 0.5, range_max_m = 20.0;
  double beam_rad = radians(1.0);  // what a step paints: the larger of the beam and the head's step
  double elevation_rad = radians(25.0);  // full height of the beam, and its bins: for the
  std::uint32_t bins_elevation = 1;      // panel's words
  // Intensities are powers re 1 uPa^2: pictures are in decibels, else in parts of their full scale.
  bool levels = false;

  double range_step_m() const { return (range_max_m - range_min_m) / n_range; }
};
// kBadInput that names the option.
Status validate(const MechanicalScanOptions& options);

struct ScanStep {
  double heading_rad = 0.0;  // azimuth of the beam in sonar axes, positive to starboard
  Pose world_from_sonar;
  double time_s = 0.0;
};

class MechanicalScan {
 public:
  // Options must be valid (CHECKed).
  explicit MechanicalScan(const MechanicalScanOptions& options);

  // One step's intensity [n_range], nearest first (CHECKed). Values that are negative or not finite
  // count as silence.
  void append(std::span<const float> intensity, const ScanStep& step);

  const MechanicalScanOptions& options() const { return options_; }
  const std::vector<ScanStep>& steps() const { return steps_; }
  std::span<const float> profile(std::size_t step) const {
    return std::span<const float>(profiles_).subspan(step * options_.n_range, options_.n_range);
  }
  // [n_range][n_steps], row 0 nearest, column 0 the first step.
  std::vector<float> sector_image() const;

 private:
  MechanicalScanOptions options_;
  std::vector<ScanStep> steps_;
  std::vector<float> profiles_;  // [steps][n_range]
};

// As the device shows it: a fan about the sonar in beams of beam_rad, each the newest step whose
// beam reaches its middle; sonar axes of whatever moment. Its limits are a full turn, or the sector
// that the head swept (which may reach past 180 degrees where it lies astern). A scan without steps
// is a silent full turn.
struct DeviceImage {
  BeamGrid grid;
  SonarImage image;
};
DeviceImage device_image(const MechanicalScan& scan);

// Motion taken out: a map in x and z (north is -z, row 0), each cell the mean of the steps whose
// beams cover its centre at the time (near the sonar a beam is as wide as a cell), at ranges
// projected onto the plane; as large as the beams and the sonar's track need. NaN: no beam. Cell
// (0, 0) has its corner at (first_column, first_row) * cell_m.
struct ScanMosaic {
  double cell_m = 0.1;
  std::int64_t first_column = 0, first_row = 0;
  std::uint32_t columns = 0, rows = 0;
  std::vector<float> intensity;
};
// kBadInput where the cell is not positive or the map holds more than 2^26 cells.
Result<ScanMosaic> scan_mosaic(const MechanicalScan& scan, double cell_m);

inline constexpr double kScanShown_db = 50.0;  // of levels: below a picture's full scale
// North up, with the sonar's track. RGB.
ImageU8 draw_mosaic(const MechanicalScan& scan, const ScanMosaic& mosaic,
                    const std::string& title = "SCANNING SONAR   WORLD",
                    std::uint32_t height_px = 900);

// mechanical.npy float32 [n_range, n_steps], mechanical_steps.csv, mechanical.png (as the device
// shows it), mechanical_world.npy float32 [rows, columns], mechanical_world.png and, last,
// mechanical.json.
Status write_mechanical_scan(const std::filesystem::path& folder, const MechanicalScan& scan,
                             double cell_m, const nlohmann::json& facts);

}  // namespace neritic::sonar
