// Notes, while a dive goes on, of devices that send what cannot be used: once each.
#pragma once

#include <set>
#include <string>

#include "testbed/devices/devices.hpp"
#include "testbed/record/step_sink.hpp"

namespace neritic::tools {

class DeviceNotes final : public testbed::StepSink {
 public:
  // Borrows the devices.
  explicit DeviceNotes(const testbed::Devices& devices) : devices_(devices) {}
  Status accept(const sim::Snapshot<testbed::PhysicsState>& step,
                std::span<const testbed::Sample>) override;
  Status finish() override;

 private:
  void look();

  const testbed::Devices& devices_;
  double next_s_ = 0.0;
  std::set<std::string> told_;
};

}  // namespace neritic::tools
