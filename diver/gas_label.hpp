// How divers write what they breathe: air, EAN32, 18/45. Any thread.
#pragma once

#include <string>
#include <string_view>

#include "diver/gas_mix.hpp"
#include "engine/core/result.hpp"

namespace neritic::diver {

// From percent, as labels say it.
GasMix mix_of_percent(double oxygen, double helium);

// "air", "o2" or "oxygen", "ean32" or "nx32" (nitrox), "18/45", "tx18/45" (trimix, oxygen/helium).
// Errors: no such text, shares that are no gas, less than 1 % of oxygen.
Result<GasMix> parse_mix(std::string_view text);
// The shortest of these names: "air", "EAN32", "18/45", "O2".
std::string name_of(const GasMix& mix);

}  // namespace neritic::diver
