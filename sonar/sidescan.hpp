// A side-scan record: each ping a line of ranges to port and one to starboard, over a track. Where
// the bottom begins, and the pictures in slant range (as the device draws them) and in ground range
// (as a map reads). Intensities are linear energies a bin. One owner, one thread.
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

namespace neritic::sonar {

struct SidescanOptions {
  std::uint32_t n_range = 500;  // a side
  double range_min_m = 0.0, range_max_m = 50.0;
  // The bottom begins in the first bin that reaches this part of the 95th percentile of the ping's
  // heard bins, and the floor.
  double relative_threshold = 0.25;
  double floor = 0.0;
  // A ping's altitude is the median of this many pings about it (odd): a fish does not move the
  // bottom.
  std::uint32_t tracking_pings = 5;

  double range_step_m() const { return (range_max_m - range_min_m) / n_range; }
};
// kBadInput that names the option.
Status validate(const SidescanOptions& options);

class SidescanRecord {
 public:
  // Options must be valid (CHECKed).
  explicit SidescanRecord(const SidescanOptions& options);

  // One ping: intensities [n_range] of each side, nearest first (CHECKed), and the pose of the
  // sonar's body (x starboard, z backwards). What is not finite or negative counts as silence.
  void append(std::span<const float> port, std::span<const float> starboard,
              const Pose& world_from_sonar, double time_s);

  const SidescanOptions& options() const { return options_; }
  std::size_t pings() const { return poses_.size(); }
  const std::vector<Pose>& poses() const { return poses_; }
  const std::vector<double>& times_s() const { return times_s_; }
  // [pings][2 * n_range]: port reversed at the left, so that range grows outwards from the middle.
  std::span<const float> slant_image() const { return image_; }

  // Metres travelled over ground until each ping; the first is 0.
  std::vector<double> along_track_m() const;
  // Slant range of the first bottom return of each ping, tracked: the height above a flat bottom.
  // NaN where none of the pings about it has one.
  std::vector<double> altitude_m() const;

 private:
  SidescanOptions options_;
  std::vector<Pose> poses_;
  std::vector<double> times_s_;
  std::vector<float> image_;
};

// [pings][2 * n_ground]: bins of equal width over a flat bottom, from the track outwards to
// ground_max_m: g = sqrt(r^2 - h^2). What a slant bin heard is shared among the ground bins that
// it covers in proportion to the part of its range that maps to each: no energy is gained or lost
// but what lies in the water column or beyond. A ping without an altitude is NaN.
struct GroundImage {
  std::uint32_t n_ground = 0;
  double ground_max_m = 0.0;
  std::vector<float> intensity;

  double bin_m() const { return ground_max_m / n_ground; }
};
// altitude_m: one a ping (CHECKed), from altitude_m() or known. n_ground > 0.
GroundImage ground_image(const SidescanRecord& record, std::span<const double> altitude_m,
                         std::uint32_t n_ground);

struct SidescanPictureOptions {
  std::string title = "SIDE-SCAN SONAR";
  std::uint32_t width_px = 1200, max_height_px = 2400;
  double full_scale = 0.0;  // value in full brightness; 0: the 99th percentile of what is heard
  double gamma = 0.5;
};
// The waterfall: a line a ping, the newest on top, the tracked bottom as a thin line. RGB.
ImageU8 draw_slant(const SidescanRecord& record, std::span<const double> altitude_m,
                   const SidescanPictureOptions& options = {});
// The ground-range picture in true proportion along and across the track, ahead up.
ImageU8 draw_ground(const SidescanRecord& record, const GroundImage& ground,
                    const SidescanPictureOptions& options = {});

// sidescan_slant.npy, sidescan_ground.npy float32 [pings, 2 n]; sidescan_altitude.npy,
// sidescan_track.npy float64 [pings] and [pings, 3]; the two pictures, and, last, sidescan.json.
Status write_sidescan(const std::filesystem::path& folder, const SidescanRecord& record,
                      const nlohmann::json& facts, const SidescanPictureOptions& picture = {});

}  // namespace neritic::sonar
