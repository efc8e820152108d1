// Names that the writer and the reader of a recording share (sample_log.hpp). Any thread.
#pragma once

namespace neritic::testbed {

inline constexpr const char* kRunMetadata = "neritic";
inline constexpr const char* kRunFormat = "1";
inline constexpr const char* kSceneAttachment = "scene.toml";
inline constexpr const char* kStateAttachment = "start.state";
inline constexpr const char* kStepTopic = "/neritic/step";
inline constexpr const char* kSourceTopic = "/neritic/source";
inline constexpr const char* kStepType = "neritic_msgs/msg/Step";
inline constexpr const char* kSourceType = "neritic_msgs/msg/Source";
inline constexpr const char* kStepLines =
    "# A state of the run: the hash of all of it.\n"
    "std_msgs/Header header\nuint64 step\nfloat64 time_s\nuint64 hash\n";
inline constexpr const char* kSourceLines =
    "# A source of samples: its number counts from 0.\n"
    "std_msgs/Header header\nuint32 source\nstring name\n";
// Keys of a channel's metadata: the stream and its kind, and whether it enters or leaves.
inline constexpr const char* kStreamKey = "stream";
inline constexpr const char* kKindKey = "kind";
inline constexpr const char* kWayKey = "way";
inline constexpr const char* kIn = "in";
inline constexpr const char* kOut = "out";

}  // namespace neritic::testbed
