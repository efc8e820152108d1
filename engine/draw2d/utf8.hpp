// UTF-8 to code points. Pure; any thread.
#pragma once

#include <cstdint>
#include <string_view>

namespace neritic::draw2d {

inline constexpr char32_t kReplacement = 0xFFFD;  // drawn as a question mark in a diamond

// Removes the first code point from a text that is not empty and returns it. Where the bytes are
// not UTF-8 (stray or missing continuation, overlong form, surrogate, above U+10FFFF), removes one
// byte and returns kReplacement, so that the fault shows.
char32_t take_code_point(std::string_view& text);

}  // namespace neritic::draw2d
