// The contents of samples as named numbers in ROS conventions (engine/core/ros_frames.hpp), the
// same for Python, the server and what else speaks to programs outside: "orientation" 4,
// "linear_acceleration" 3. Pure functions; any thread.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/core/ros_frames.hpp"
#include "testbed/samples/sample.hpp"

namespace neritic::testbed::ros {
using namespace neritic::ros;

struct Field {
  std::string name;  // with its unit where ROS does not fix it: "pressure_pa"
  std::uint32_t count = 1;
};

// The fields of a kind of payload, in the order of their values. Empty: an event.
std::vector<Field> fields_of(PayloadKind kind);
std::size_t value_count(PayloadKind kind);
// No reading that leaves has more values.
inline constexpr std::size_t kMostReadingValues = 32;

// Precondition: value_count() of its kind fit. Returns that count.
std::size_t write_values(const Payload& payload, std::span<double> out);
// kBadInput where a number of a choice, a count or bits is none of those that there are.
Status check_values(PayloadKind kind, std::span<const double> values, std::string_view where);
// Rotations whose length is 1 within the tolerance of plausible() are made unit; others stay as
// they are, so that it refuses them. Precondition: value_count(kind) values, all finite.
Payload read_values(PayloadKind kind, std::span<const double> values);
// The line for values of which plausible() is false: the first rotation that is none, or the limits
// of places, speeds and forces. Precondition: as above.
Error implausible(PayloadKind kind, std::span<const double> values, std::string_view where);

// The frame of a reading's vectors: "rov/imu", "rov" or "world".
std::string frame_of(PayloadKind kind, const std::string& owner);

}  // namespace neritic::testbed::ros
