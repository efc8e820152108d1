// Keeps a view's frames within a budget: quality comes down one rung after another where the
// machine is too slow, and back up where it has room. A rung that was too much is tried again later
// each time, so that the picture does not swing. Plain value; rendering thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "engine/scene/picture_detail.hpp"

namespace neritic::testbed {

struct Quality {
  double view_scale = 1.0;       // of the view's width and height in pixels
  std::uint32_t ping_every = 1;  // each sonar gives one of this number of due pings
  std::uint32_t light = 0;       // 0: as the camera says; to kLightLevels - 1, each cheaper
  friend bool operator==(const Quality&, const Quality&) = default;
};

inline constexpr std::uint32_t kLightLevels = 4;

// Best first: some of the view's resolution, then the knobs of light and water, then the sonars'
// rates, and so on in turn.
std::span<const Quality> quality_rungs();

// A camera's knobs at a level of light: none finer than the camera has it.
scene::PictureDetail detail_at(const scene::PictureDetail& camera, std::uint32_t light);

class QualityGovernor {
 public:
  // budget_ms: of a frame, above 0.
  explicit QualityGovernor(double budget_ms) : budget_ms_(budget_ms) {}

  // One frame that was seen. interval_ms: since the frame before; work_ms: the time that host and
  // device were busy with it, at most the interval. Values that are no time above 0 are left out.
  void add(double interval_ms, double work_ms);

  const Quality& quality() const { return quality_rungs()[rung_]; }
  std::size_t rung() const { return rung_; }
  double budget_ms() const { return budget_ms_; }

 private:
  static constexpr std::size_t kFrames = 5;  // a decision's: the middle one counts
  void forget();
  void go_down(double interval_ms);
  void go_up(double work_ms);

  double budget_ms_;
  std::size_t rung_ = 0;
  std::array<double, kFrames> interval_ms_{}, work_ms_{};
  std::size_t frames_ = 0, skip_ = 3;  // the first frames make pipelines
  double on_rung_s_ = 0.0;
  // Each rung's wait before a climb to it.
  std::array<double, 16> wait_s_ = filled(1.0);
  bool climbed_ = false;  // the last change was a climb

  static constexpr std::array<double, 16> filled(double value) {
    std::array<double, 16> out{};
    for (double& x : out) x = value;
    return out;
  }
};

}  // namespace neritic::testbed
