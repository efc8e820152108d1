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
  double relative_threshold = 0.05;
  double floor = 0.0;
  std::vector<float> floor_by_bin;  // [n_range], what a bin must exceed as well; empty: nothing
  // A side's first return is the median of this many pings about it (odd): a fish does not move the
  // bottom.
  std::uint32_t tracking_pings = 5;
  bool levels = false;  // intensities are powers re 1 uPa^2: pictures give their scale in decibels

  double range_step_m() const { return (range_max_m - range_min_m) / n_range; }
};
// kBadInput that names the option.
Status validate(const SidescanOptions& options);

// Slant range of each ping's first bottom return, tracked on either side by itself: over a slope
// they differ, and what hides one leaves the other. NaN where none of the pings about it has one.
struct FirstReturns {
  std::vector<double> port_m, starboard_m;
  // The nearer of both, a ping: the height above a flat bottom.
  std::vector<double> altitude_m() const;
};

class SidescanRecord {
 public:
  // Options must be valid (CHECKed).
  explicit SidescanRecord(const SidescanOptions& options);

  // One ping: intensities [n_range] of each side, nearest first (CHECKed), and the pose of the
  // sonar's body (x starboard, z backwards). Negative or not finite values count as silence.
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
  FirstReturns first_returns() const;

 private:
  std::vector<double> tracked_m(bool port) const;
  SidescanOptions options_;
  std::vector<Pose> poses_;
  std::vector<double> times_s_;
  std::vector<float> image_;
};

// [pings][2 * n_ground]: bins of equal width over a flat bottom, from the track outwards to
// ground_max_m: g = sqrt(r^2 - h^2). A slant bin's energy is shared among the ground bins that it
// covers in proportion to the part of its range that maps to each: no energy is gained or lost
// but what lies in the water column or beyond. A side without a first return takes the other's; a
// ping without either is NaN.
struct GroundImage {
  std::uint32_t n_ground = 0;
  double ground_max_m = 0.0;
  std::vector<float> intensity;

  double bin_m() const { return ground_max_m / n_ground; }
};
// bottom: one a ping and side (CHECKed), from first_returns() or known. n_ground > 0.
GroundImage ground_image(const SidescanRecord& record, const FirstReturns& bottom,
                         std::uint32_t n_ground);

struct SidescanPictureOptions {
  std::string title = "SIDE-SCAN SONAR";
  std::uint32_t width_px = 1200, max_height_px = 2400;
  double full_scale = 0.0;  // value in full brightness; 0: the 99th percentile of what is heard
  double gamma = 0.5;
};
// The waterfall: a line a ping, the newest on top, the tracked bottom as a thin line. RGB.
ImageU8 draw_slant(const SidescanRecord& record, const FirstReturns& bottom,
                   const SidescanPictureOptions& options = {});
// The ground-range picture in true proportion along and across the track, ahead up; where that
// takes less than a quarter of the width, the track's beginning, which the picture says.
ImageU8 draw_ground(const SidescanRecord& record, const GroundImage& ground,
                    const SidescanPictureOptions& options = {});

// sidescan_slant.npy, sidescan_ground.npy float32 [pings, 2 n]; float64: sidescan_altitude.npy
// [pings], sidescan_first_returns.npy [pings, port and starboard], sidescan_track.npy [pings, 3];
// the two pictures, and, last, sidescan.json.
Status write_sidescan(const std::filesystem::path& folder, const SidescanRecord& record,
                      const nlohmann::json& facts, const SidescanPictureOptions& picture = {});

}  // namespace neritic::sonar
