// Materials that an object's surface may be called after. Their densities and sound speeds are in
// sonar/acoustics_materials.cpp; a test there holds both lists to the same names.
#pragma once

#include <array>
#include <string_view>

namespace neritic::scene {

inline constexpr auto kMaterialNames = std::to_array<std::string_view>(
    {"water",        "air",      "steel",     "aluminium", "brass",   "bronze",   "cast_iron",
     "lead",         "titanium", "acrylic",   "concrete",  "glass",   "ice",      "oak",
     "pine",         "rock",     "limestone", "chalk",     "moraine", "gravel",   "coarse_sand",
     "sand",         "silt",     "mud",       "clay",      "rubber",  "neoprene", "pvc",
     "polyethylene", "tissue",   "skin",      "fat",       "bone"});

}  // namespace neritic::scene
