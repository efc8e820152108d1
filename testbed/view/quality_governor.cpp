#include "testbed/view/quality_governor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace neritic::testbed {
namespace {

constexpr std::array<Quality, kRungs> kAll{
    {{1.0, 1, 0},  {0.9, 1, 0},  {0.8, 1, 0},   {0.8, 1, 1},  {0.7, 1, 1},  {0.6, 1, 1},
     {0.6, 2, 2},  {0.5, 2, 2},  {0.5, 4, 3},   {0.45, 4, 3}, {0.45, 8, 4}, {0.42, 8, 4},
     {0.39, 8, 4}, {0.36, 8, 4}, {0.335, 8, 4}, {0.31, 8, 4}, {0.29, 8, 4}, {0.27, 8, 4},
     {0.25, 8, 4}, {0.23, 8, 4}, {0.21, 8, 4},  {0.2, 16, 4}}};

// The knobs of the levels of light; the first leaves the camera its own.
const std::array<scene::PictureDetail, kLightLevels> kLight{{{},
                                                             {.shadow_size = 0.5,
                                                              .shadow_samples = 5,
                                                              .occlusion_samples = 0.5,
                                                              .inscatter_samples = 2,
                                                              .waves = 24,
                                                              .scatter_levels = 6,
                                                              .shaft_samples = 0.67,
                                                              .particles = 0.7},
                                                             {.shadow_size = 0.5,
                                                              .cascades = 2,
                                                              .shadow_samples = 3,
                                                              .visibility_step = 4,
                                                              .mesh_error = 2.5,
                                                              .occlusion_samples = 0.25,
                                                              .inscatter_samples = 1,
                                                              .waves = 16,
                                                              .scatter_levels = 4,
                                                              .shaft_samples = 0.5,
                                                              .particles = 0.5},
                                                             {.shadow_size = 0.25,
                                                              .cascades = 1,
                                                              .shadow_samples = 1,
                                                              .visibility_step = 4,
                                                              .mesh_error = 2.5,
                                                              .occlusion_samples = 0.125,
                                                              .inscatter_samples = 1,
                                                              .waves = 8,
                                                              .scatter_levels = 2,
                                                              .shaft_samples = 0.34,
                                                              .particles = 0.25},
                                                             {.shadow_size = 0.25,
                                                              .cascades = 1,
                                                              .shadow_samples = 1,
                                                              .visibility_step = 4,
                                                              .mesh_error = 2.5,
                                                              .occlusion_samples = 0.125,
                                                              .inscatter_samples = 1,
                                                              .waves = 4,
                                                              .scatter_levels = 2,
                                                              .shaft_samples = 0.25,
                                                              .particles = 0.2}}};

const std::array<Thrift, kLightLevels> kThrift{
    {{},
     {},
     {},
     {.spot_px = 0.4},
     {.forward_scatter = false, .spot_px = 0.8, .mesh_error_px = 3.0}}};

// A guess of a level's cost beside the best: it steers how far a step goes, and misses correct it.
constexpr std::array<double, kLightLevels> kLightCost{1.0, 0.75, 0.6, 0.5, 0.42};

constexpr double kMissed = 1.08;  // of the budget: slower is a miss
constexpr double kFarOver = 3.0;
constexpr double kRoom =
    0.85;  // of the budget: the most work that a better rung may be expected to take
constexpr std::size_t kInFlight = 3;  // frames after a change that were begun before it
constexpr double kSettled_s = 5.0, kLongestWait_s = 60.0;

// A view's expected work over that of the best rung, as if all of it grew with the pixels.
double cost(const Quality& quality) {
  return quality.view_scale * quality.view_scale * kLightCost[quality.light];
}

// At the last level of light: what two cores draw in 50 ms.
constexpr double kPixelsOnCpu = 1.0e5;
constexpr double kPingSmoothing = 0.3;  // share of a new ping

double middle(std::array<double, 5> values) {
  std::nth_element(values.begin(), values.begin() + 2, values.end());
  return values[2];
}

}  // namespace

std::span<const Quality> quality_rungs() {
  return kAll;
}

scene::PictureDetail detail_at(const scene::PictureDetail& camera, std::uint32_t light) {
  if (light == 0) return camera;
  scene::PictureDetail out = camera;
  const scene::PictureDetail& level = kLight.at(light);
  out.shadow_size = std::min(out.shadow_size, level.shadow_size);
  out.cascades = std::min(out.cascades, level.cascades);
  out.shadow_samples = std::min(out.shadow_samples, level.shadow_samples);
  out.visibility_step = std::max(out.visibility_step, level.visibility_step);
  out.mesh_error = std::max(out.mesh_error, level.mesh_error);
  out.occlusion_samples = std::min(out.occlusion_samples, level.occlusion_samples);
  out.inscatter_samples = std::min(out.inscatter_samples, level.inscatter_samples);
  out.waves = std::min(out.waves, level.waves);
  out.shaft_samples = std::min(out.shaft_samples, level.shaft_samples);
  out.scatter_levels = std::min(out.scatter_levels, level.scatter_levels);
  out.particles = std::min(out.particles, level.particles);
  return out;
}

Thrift thrift_at(std::uint32_t light) {
  return kThrift.at(light);
}

std::vector<std::string> given_up(const Quality& quality, bool sonars) {
  std::vector<std::string> lines;
  const bool skips = sonars && quality.ping_every > 1;
  if (quality.view_scale < 1.0 || skips)
    lines.push_back(fmt::format("drawn at {:.0f} %{}", 100.0 * quality.view_scale,
                                skips ? fmt::format("   1 ping of {}", quality.ping_every) : ""));
  if (quality.light > 0)
    lines.push_back(
        fmt::format("light {} of {} lower{}", quality.light, kLightLevels - 1,
                    thrift_at(quality.light).forward_scatter ? "" : ", no forward scatter"));
  return lines;
}

std::size_t first_rung_on_cpu(double pixels) {
  const auto fits = [&](const Quality& q) {
    return pixels * cost(q) <= kPixelsOnCpu * kLightCost.back();
  };
  const auto found = std::ranges::find_if(kAll, fits);
  return static_cast<std::size_t>(std::min(found, kAll.end() - 1) - kAll.begin());
}

void QualityGovernor::add(double interval_ms, double work_ms, bool pinged) {
  if (!(std::isfinite(interval_ms) && interval_ms > 0.0 && work_ms > 0.0)) return;
  on_rung_s_ += interval_ms * 1e-3;
  ++since_ping_;
  if (skip_ > 0) {
    --skip_;
    return;
  }
  pinged_in_row_ = pinged ? pinged_in_row_ + 1 : 0;
  // Where every frame has a ping, a frame with one is the usual one.
  const bool always = pinged_in_row_ >= kFrames;
  if (pinged && !always && usual_ms_ > 0.0) return add_ping(interval_ms);
  // Pings that stay away cost nothing any more.
  ping_ms_ = always ? 0.0 : std::min(ping_ms_, beyond_ms_ / static_cast<double>(since_ping_));
  interval_ms_[frames_ % kFrames] = interval_ms;
  work_ms_[frames_ % kFrames] = std::min(work_ms, interval_ms);
  ++frames_;
  // Far over the budget two frames are enough: five would show for seconds what is a slide show.
  if (frames_ == 2 && std::min(interval_ms_[0], interval_ms_[1]) > kFarOver * budget_ms_) {
    go_down(std::min(interval_ms_[0], interval_ms_[1]));
    return;
  }
  if (frames_ < kFrames) return;
  usual_ms_ = middle(interval_ms_);
  const double interval = usual_ms_ + ping_ms_;
  if (interval > kMissed * budget_ms_) {
    go_down(interval);
  } else {
    if (climbed_ && on_rung_s_ > kSettled_s) wait_s_[rung_] = 1.0;  // it holds
    go_up(middle(work_ms_) + ping_ms_);
  }
}

// A sonar's frame says nothing of the others.
void QualityGovernor::add_ping(double interval_ms) {
  beyond_ms_ = std::min(std::max(interval_ms - usual_ms_, 0.0), 8.0 * budget_ms_);
  const double share_ms = beyond_ms_ / static_cast<double>(since_ping_);
  ping_ms_ += kPingSmoothing * (share_ms - ping_ms_);
  since_ping_ = 0;
}

// To the rung whose cost is expected to fit: at least one, and at most three (eight, where frames
// are far over the budget), since fixed costs make the guess too good.
void QualityGovernor::go_down(double interval_ms) {
  finding_ = false;
  if (rung_ + 1 >= kAll.size()) return;
  if (climbed_ && on_rung_s_ <= kSettled_s)
    wait_s_[rung_] = std::min(2.0 * wait_s_[rung_], kLongestWait_s);
  const double wanted = cost(quality()) * budget_ms_ / interval_ms;
  const std::size_t reach = interval_ms > kFarOver * budget_ms_ ? 8 : 3;
  const std::size_t farthest = std::min(rung_ + reach, kAll.size() - 1);
  std::size_t next = rung_ + 1;
  while (next < farthest && cost(kAll[next]) > wanted) ++next;
  move_to(next);
  climbed_ = false;
}

void QualityGovernor::go_up(double work_ms) {
  const double now = cost(quality());
  const auto has_room = [&](std::size_t rung) {
    return work_ms * cost(kAll[rung]) / now <= kRoom * budget_ms_;
  };
  if (rung_ == 0 || !(finding_ || on_rung_s_ >= wait_s_[rung_ - 1])) return;
  if (!has_room(rung_ - 1)) {
    finding_ = false;
    return;
  }
  std::size_t next = rung_ - 1;
  while (finding_ && next > 0 && has_room(next - 1)) --next;
  move_to(next);
  climbed_ = true;
}

// Forgets the frames of the old rung. The pings' share stays, scaled to their new rate.
void QualityGovernor::move_to(std::size_t rung) {
  const double rate = static_cast<double>(kAll[rung_].ping_every) / kAll[rung].ping_every;
  ping_ms_ *= rate;
  beyond_ms_ = std::max(beyond_ms_, ping_ms_);
  rung_ = rung;
  frames_ = 0;
  skip_ = kInFlight;
  on_rung_s_ = 0.0;
}

}  // namespace neritic::testbed
