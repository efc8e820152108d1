// Keeps a view's frames within a budget: quality comes down one rung after another where the
// machine is too slow, and back up where it has room. A rung that was too much is tried again later
// each time, so that the picture does not swing. Plain value; rendering thread.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/scene/picture_detail.hpp"
#include "testbed/sensors/frame_request.hpp"

namespace neritic::testbed {

struct Quality {
  double view_scale = 1.0;       // of the view's width and height in pixels
  std::uint32_t ping_every = 1;  // each sonar gives one of this number of due pings
  std::uint32_t light = 0;       // 0: as the camera says; to kLightLevels - 1, each cheaper
  friend bool operator==(const Quality&, const Quality&) = default;
};

inline constexpr std::uint32_t kLightLevels = 5;
inline constexpr std::size_t kRungs = 22;

// Best first: some of the view's resolution, then the knobs of light and water, then the sonars'
// rates, and so on in turn; all of light and water before the last of the resolution.
std::span<const Quality> quality_rungs();

// A camera's knobs at a level of light: none finer than the camera has it.
scene::PictureDetail detail_at(const scene::PictureDetail& camera, std::uint32_t light);
// And what is left out there.
Thrift thrift_at(std::uint32_t light);
// Lines that tell a person each thing that is less than at the best rung; none at the best.
// sonars: whether there are any, whose rates it lowers too.
std::vector<std::string> given_up(const Quality& quality, bool sonars = true);

// Where a machine without a graphics card begins with pictures of so many pixels: two cores draw
// that in time. The whole picture first, and the way down from it, would be seconds of a slide
// show.
std::size_t first_rung_on_cpu(double pixels);

class QualityGovernor {
 public:
  // budget_ms: of a frame, above 0. rung: where it begins.
  explicit QualityGovernor(double budget_ms, std::size_t rung = 0)
      : budget_ms_(budget_ms), rung_(rung), finding_(rung > 0) {}

  // One frame that was seen. interval_ms: since the frame before; work_ms: the time that host and
  // device were busy with it, at most the interval. pinged: sonars were drawn in it; what it took
  // longer is counted as if all frames shared it. Values that are no time above 0 are left out.
  void add(double interval_ms, double work_ms, bool pinged = false);

  const Quality& quality() const { return quality_rungs()[rung_]; }
  std::size_t rung() const { return rung_; }
  double budget_ms() const { return budget_ms_; }
  // A longer one than now changes nothing.
  void shorten_budget(double budget_ms) { budget_ms_ = std::min(budget_ms_, budget_ms); }

 private:
  static constexpr std::size_t kFrames = 5;  // a decision's: the middle one counts
  void move_to(std::size_t rung);
  void add_ping(double interval_ms);
  void go_down(double interval_ms);
  void go_up(double work_ms);

  double budget_ms_;
  std::size_t rung_;
  bool finding_;  // the first climb, over as many rungs as have room, without waiting
  std::array<double, kFrames> interval_ms_{}, work_ms_{};
  std::size_t frames_ = 0, skip_ = 3;  // the first frames make pipelines
  double on_rung_s_ = 0.0;
  double usual_ms_ = 0.0;       // the last decision's frame without a ping; 0: none was made
  double ping_ms_ = 0.0;        // a frame's share of pings
  double beyond_ms_ = 0.0;      // that the last ping took longer than a frame without one
  std::size_t since_ping_ = 0;  // frames
  std::size_t pinged_in_row_ = 0;
  // Each rung's wait before a climb to it.
  std::array<double, kRungs> wait_s_ = filled(1.0);
  bool climbed_ = false;  // the last change was a climb

  static constexpr std::array<double, kRungs> filled(double value) {
    std::array<double, kRungs> out{};
    for (double& x : out) x = value;
    return out;
  }
};

}  // namespace neritic::testbed
