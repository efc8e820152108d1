// Samples as messages of a recording, with every bit: what was used can be used again. Their
// definitions follow from the payloads (payloads.hpp), in whose units and axes they are. Pure
// functions; any thread.
#pragma once

#include <optional>
#include <string>

#include "engine/recording/mcap.hpp"
#include "testbed/samples/sample.hpp"

namespace neritic::testbed {

// "neritic_msgs/msg/Joints", after the kind's name.
std::string message_type(PayloadKind kind);
recording::McapSchema sample_schema(PayloadKind kind);

// When a sample entered or left: the step that uses it first, or whose state it is of; and the
// scene's time when it was captured.
struct SampleMoment {
  std::uint64_t step = 0;
  std::int64_t captured_scene_ns = 0;
};
// The bytes of a message. The stream is not in it: it is the channel.
std::string sample_message(const Sample& sample, const SampleMoment& moment);
struct ReadSample {
  Sample sample;  // its stream is 0
  std::uint64_t step = 0;
};
// Nothing where the bytes are not a whole message of that kind.
std::optional<ReadSample> read_sample(PayloadKind kind, std::span<const std::byte> bytes);

}  // namespace neritic::testbed
