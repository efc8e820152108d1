// Letters as strokes on a small grid, drawn for this project. Capitals are 6 units high.
#pragma once

#include <cstdint>
#include <string_view>

namespace neritic::sonar {

// Polylines separated by spaces; a point is a digit (x) and a letter (y: 'c' baseline, 'g' height
// of small letters, 'i' of capitals, 'a' lowest). Empty for a blank or a letter that is not known.
std::string_view strokes_of(std::uint32_t code_point);
inline double stroke_x(char c) {
  return c - '0';
}
inline double stroke_y(char c) {
  return c - 'c';
}
inline constexpr double kCapitalHeight = 6.0, kLetterGap = 2.0, kBlankWidth = 2.0;

}  // namespace neritic::sonar
