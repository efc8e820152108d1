// The one form of a line that refuses a file, a key or a flag: "WHERE: found X; accepted: Y". WHERE
// is the file with its line, the key or the flag, joined by ": ". Pure functions; any thread.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

#include "engine/core/result.hpp"

namespace neritic {

// For readers that add the place themselves.
inline std::string found_accepted(std::string_view found, std::string_view accepted) {
  return fmt::format("found {}; accepted: {}", found, accepted);
}

// where empty: the caller adds the place.
inline Error refusal(std::string_view where, std::string_view found, std::string_view accepted) {
  const std::string_view colon = where.empty() ? "" : ": ";
  return bad_input("{}{}{}", where, colon, found_accepted(found, accepted));
}

}  // namespace neritic
