// The sound of a scene's microphones in its recording (--record): a topic SOURCE/sound each, which
// `neritic recording export --format wav` makes a .wav of. A step sink: the stepping thread.
#pragma once

#include <optional>

#include "testbed/devices/devices.hpp"
#include "testbed/record/recording_file.hpp"

namespace neritic::tools {

class SoundRecord final : public testbed::StepSink {
 public:
  // Borrows both.
  SoundRecord(const testbed::Devices& devices, testbed::RecordingFile& recording);
  Status accept(const sim::Snapshot<testbed::PhysicsState>& step,
                std::span<const testbed::Sample> outputs) override;
  Status finish() override { return {}; }

 private:
  struct Microphone {
    testbed::DeviceSource* device = nullptr;
    std::optional<std::uint16_t> channel;
    std::uint32_t sequence = 0;
  };
  std::vector<Microphone> microphones_;
  testbed::RecordingFile& recording_;
  std::optional<std::uint16_t> schema_;
};

}  // namespace neritic::tools
