// The one rule for names of sources of samples (a suit, a client of the server, a program), kept by
// scenes, the inbox, the server, saved states and recordings: a name that one of them accepts can
// be written and read by all others. Pure functions; any thread.
#pragma once

#include <string_view>

#include "engine/core/result.hpp"

namespace neritic {

inline constexpr std::size_t kLongestSourceName = 64;
// The source of what the simulation itself sends: each inbox's first.
inline constexpr std::string_view kSimulationName = "simulation";
inline constexpr std::string_view kAcceptedSourceName =
    "1 to 64 printable ASCII characters without spaces, but autopilot, nobody, recording, "
    "simulation";

// Whether something outside of the simulation may be called so. The words that a group of `inputs`
// may have instead of a source (autopilot, nobody, recording) are no names.
bool names_a_source(std::string_view name);

// kBadInput: "WHERE: found ...; accepted: ...".
Status check_source_name(std::string_view where, std::string_view name);

}  // namespace neritic
