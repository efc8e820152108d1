#include "tools/neritic/device_notes.hpp"

#include "engine/core/log.hpp"

namespace neritic::tools {
namespace {

constexpr double kDeviceLook_s = 1.0;

}  // namespace

Status DeviceNotes::accept(const sim::Snapshot<testbed::PhysicsState>& step,
                           std::span<const testbed::Sample>) {
  // A state that was restored may lie before the last look.
  if (step.time_s < next_s_ && step.time_s >= next_s_ - kDeviceLook_s) return {};
  next_s_ = step.time_s + kDeviceLook_s;
  look();
  return {};
}

Status DeviceNotes::finish() {
  look();
  return {};
}

void DeviceNotes::look() {
  for (const testbed::DeviceHealth& health : devices_.health()) {
    // One that nobody heard is not connected, which is no fault yet.
    if (health.trouble.empty() || health.heard_ns == 0) continue;
    const std::string line = fmt::format("source {}: {}", health.name, health.trouble);
    if (told_.insert(line).second) log_warn("{}", line);
  }
}

}  // namespace neritic::tools
