#include "tools/neritic/sound_record.hpp"

#include <algorithm>
#include <cmath>

#include "engine/recording/cdr.hpp"
#include "engine/recording/ros_types.hpp"

namespace neritic::tools {
using namespace testbed;

SoundRecord::SoundRecord(const Devices& devices, RecordingFile& recording) : recording_(recording) {
  for (const auto& device : devices.all())
    if (device->hears()) {
      device->sound().want();
      microphones_.push_back({device.get()});
    }
}

Status SoundRecord::accept(const sim::Snapshot<PhysicsState>& step, std::span<const Sample>) {
  const auto log_ns = static_cast<std::uint64_t>(std::llround(1e9 * step.time_s));
  for (Microphone& microphone : microphones_)
    for (const HeardSound& sound : microphone.device->sound().take()) {
      if (recording_.failed()) return {};
      recording::McapOut& out = recording_.out();
      if (!schema_) schema_ = out.add_schema(recording::ros_schema("neritic_msgs/msg/Audio"));
      if (!microphone.channel)
        microphone.channel =
            out.add_channel({*schema_, "/" + microphone.device->name() + "/sound", "cdr", {}});
      const TimeNs stamp_ns = std::max<TimeNs>(sound.captured_ns + step.scene_from_host_ns(), 0);
      std::string message;
      recording::CdrWriter cdr(message);
      cdr.header(stamp_ns, microphone.device->name());
      cdr.number(sound.rate_hz);
      cdr.count(sound.samples.size());
      for (const float sample : sound.samples) cdr.number(sample);
      out.message({*microphone.channel, microphone.sequence++, log_ns,
                   static_cast<std::uint64_t>(stamp_ns), std::as_bytes(std::span(message))});
    }
  return {};
}

}  // namespace neritic::tools
