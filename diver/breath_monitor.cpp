#include "diver/breath_monitor.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/check.hpp"
#include "engine/core/refusal.hpp"

namespace neritic::diver {

Status check_breath_settings(const BreathSettings& settings) {
  if (!(settings.block_s >= 0.5 && settings.block_s <= 60.0))
    return refusal("breath", fmt::format("blocks of {:g} s", settings.block_s), "0.5 to 60");
  if (!(settings.window_s >= settings.block_s && settings.window_s <= 300.0))
    return refusal("breath", fmt::format("a window of {:g} s", settings.window_s),
                   fmt::format("{:g} to 300", settings.block_s));
  return {};
}

BreathAnalyser::BreathAnalyser(double rate_hz, const BreathSettings& settings)
    : rate_hz_(rate_hz), settings_(settings), bands_(rate_hz) {
  NERITIC_CHECK(check_breath_settings(settings).ok(), "{} {}", settings.block_s, settings.window_s);
}

const BreathState& BreathAnalyser::take(std::span<const float> sound) {
  for (const float sample : sound) bands_.push(sample, frames_);
  samples_ += sound.size();
  const double history_s = std::max(settings_.window_s, kSlowWindow_s);
  const auto most = static_cast<std::size_t>(std::lround(history_s * kBreathFrames_hz));
  if (frames_.size() > most)
    frames_.erase(frames_.begin(), frames_.end() - static_cast<std::ptrdiff_t>(most));
  state_.time_s = static_cast<double>(samples_) / rate_hz_ + lost_s_;
  state_.estimate =
      estimate_newest_breath(frames_, settings_.window_s, bands_, settings_.estimator);
  const auto window = static_cast<std::size_t>(std::lround(settings_.window_s * kBreathFrames_hz));
  state_.quiet_s = quiet_for(std::span(frames_).last(std::min(window, frames_.size())), bands_);
  state_.refused = bands_.refused();
  ++state_.blocks;
  return state_;
}

void BreathAnalyser::lose(std::uint64_t blocks, double seconds) {
  state_.lost_blocks += blocks;
  lost_s_ += seconds;
  frames_.clear();
}

std::vector<BreathState> analyse_breath(const Recording& sound, const BreathSettings& settings) {
  BreathAnalyser analyser(sound.rate_hz, settings);
  const auto block = static_cast<std::size_t>(std::lround(settings.block_s * sound.rate_hz));
  std::vector<BreathState> out;
  std::vector<float> part;
  for (std::size_t from = 0; from < sound.samples.size(); from += block) {
    const std::size_t count = std::min(block, sound.samples.size() - from);
    const auto begin = sound.samples.begin() + static_cast<std::ptrdiff_t>(from);
    part.assign(begin, begin + static_cast<std::ptrdiff_t>(count));
    out.push_back(analyser.take(part));
  }
  return out;
}

BreathMonitor::BreathMonitor(double rate_hz, const BreathSettings& settings)
    : rate_hz_(rate_hz),
      block_samples_(static_cast<std::size_t>(std::lround(settings.block_s * rate_hz))),
      analyser_(rate_hz, settings) {
  recording_.reserve(block_samples_);
  handed_.reserve(block_samples_);
  thread_ = std::thread([this] { analyse(); });
}

BreathMonitor::~BreathMonitor() {
  stop_ = true;
  work_.release();
  thread_.join();
}

void BreathMonitor::record(std::span<const float> sound) {
  while (!sound.empty()) {
    const std::size_t some = std::min(sound.size(), block_samples_ - recording_.size());
    recording_.insert(recording_.end(), sound.begin(),
                      sound.begin() + static_cast<std::ptrdiff_t>(some));
    sound = sound.subspan(some);
    if (recording_.size() < block_samples_) return;
    if (full_.load(std::memory_order_acquire))
      ++lost_;
    else
      hand_over();
    recording_.clear();
  }
}

// Precondition: not full_.
void BreathMonitor::hand_over() {
  recording_.swap(handed_);
  handed_lost_ = lost_;
  lost_ = 0;
  full_.store(true, std::memory_order_release);
  work_.release();
}

void BreathMonitor::analyse() {
  while (true) {
    work_.acquire();
    if (full_.load(std::memory_order_acquire)) {
      if (handed_lost_ > 0)
        analyser_.lose(handed_lost_, static_cast<double>(handed_lost_ * block_samples_) / rate_hz_);
      states_.publish(analyser_.take(handed_));
      full_.store(false, std::memory_order_release);
      full_.notify_all();
    }
    if (stop_) return;
  }
}

void BreathMonitor::wait() {
  full_.wait(true, std::memory_order_acquire);
}

void BreathMonitor::finish() {
  wait();
  if (recording_.empty()) return;
  hand_over();
  recording_.clear();
  wait();
}

const BreathState& BreathMonitor::state() {
  states_.update();
  return states_.newest();
}

}  // namespace neritic::diver
