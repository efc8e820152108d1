#include "engine/core/source_name.hpp"

#include <algorithm>
#include <array>

#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"

namespace neritic {

bool names_a_source(std::string_view name) {
  constexpr std::array<std::string_view, 4> kTaken{"autopilot", "nobody", "recording",
                                                   kSimulationName};
  return !name.empty() && name.size() <= kLongestSourceName &&
         std::ranges::all_of(name, [](char c) { return c > ' ' && c <= '~'; }) &&
         std::ranges::find(kTaken, name) == kTaken.end();
}

Status check_source_name(std::string_view where, std::string_view name) {
  if (names_a_source(name)) return {};
  const std::string found = name.size() > kLongestSourceName
                                ? fmt::format("a name of {} bytes", name.size())
                                : fmt::format("'{}'", printable(name, kLongestSourceName));
  return refusal(where, found, kAcceptedSourceName);
}

}  // namespace neritic
