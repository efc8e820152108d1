// Materials by name: density and sound speed, for reflection from impedance. A constant table; any
// thread.
#pragma once

#include <span>
#include <string_view>

#include "sonar/acoustics.hpp"

namespace neritic::sonar {

struct Material {
  std::string_view name;
  Medium medium;  // solids: the compressional wave's speed
  std::string_view source;
};

// Fresh water near 20 C: what the reflection coefficients in documents and tests are from.
inline constexpr Medium kReferenceWater{997.0, 1480.0};

std::span<const Material> materials();
// kBadInput names the nearest known name and all of them.
Result<Medium> material_of(std::string_view name);

}  // namespace neritic::sonar
