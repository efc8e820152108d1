// Small text helpers of readers: numbers without locale, one-line echoes of what a file
// held, the nearest of a list of names. Pure functions; any thread.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace neritic {

// The whole word as a number (nan and inf included); nothing where it is not one.
std::optional<double> parse_number(std::string_view word);

std::string lower_case(std::string_view text);

// For messages: control characters and bytes that are not UTF-8 become '?', long text is cut.
std::string printable(std::string_view text, std::size_t max_bytes = 60);

// The name with the smallest edit distance to word (the first of equals); empty for an empty list.
std::string_view nearest(std::string_view word, std::span<const std::string_view> names);

// Whether a word is a slip of the pen for a name: the same but for capitals, or one edit away, or
// two where the name has eight letters or more.
bool is_slip(std::string_view word, std::string_view name);

// "a, b, c"
std::string join(std::span<const std::string_view> names);

}  // namespace neritic
