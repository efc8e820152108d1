// The records of MCAP, a container of messages with times, schemas and indexes (format 0,
// mcap.dev): what the writer and the reader share. Times are nanoseconds from the recording's own
// zero. Plain values; any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace neritic::recording {

// The first and the last bytes of a whole file.
inline constexpr std::string_view kMcapMagic{"\x89MCAP0\r\n", 8};

enum class McapOp : std::uint8_t {
  kHeader = 1,
  kFooter,
  kSchema,
  kChannel,
  kMessage,
  kChunk,
  kMessageIndex,
  kChunkIndex,
  kAttachment,
  kAttachmentIndex,
  kStatistics,
  kMetadata,
  kMetadataIndex,
  kSummaryOffset,
  kDataEnd,
};

using Words = std::map<std::string, std::string>;

struct McapSchema {
  std::string name;      // "sensor_msgs/msg/Imu"
  std::string encoding;  // "ros2msg"
  std::string data;
};
struct McapChannel {
  std::uint16_t schema = 0;  // 0: none
  std::string topic;         // "/rov/imu"
  std::string encoding;      // "cdr"
  Words metadata;
};
struct McapMessage {
  std::uint16_t channel = 0;
  std::uint32_t sequence = 0;
  std::uint64_t log_ns = 0, publish_ns = 0;
  std::span<const std::byte> data;  // borrowed
};
struct McapAttachment {
  std::uint64_t log_ns = 0, create_ns = 0;
  std::string name, media_type;
  std::span<const std::byte> data;  // borrowed
};
struct McapMetadata {
  std::string name;
  Words words;
};

}  // namespace neritic::recording
