// The way of a participant of a recorded dive (testbed/record/RECORDING.md): its odometry, as keys
// of a track. One thread, while a scene loads.
#pragma once

#include <filesystem>
#include <string>

#include "engine/core/result.hpp"
#include "engine/scene/track.hpp"

namespace neritic::scene {

inline constexpr std::size_t kMostRecordedPlaces = 2'000'000;  // 9 hours at 60 Hz

// Places and attitudes at the recording's times, as many of each. A recording that was cut off is
// read up to its last whole chunk. kBadInput: not a recording, no such participant in it (with
// those that there are), fewer than two places.
Result<Track> read_recorded_track(const std::filesystem::path& file,
                                  const std::string& participant);

}  // namespace neritic::scene
