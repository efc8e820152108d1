// Copies of an object: from rows of numbers, or a .csv file of such rows. Any thread.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/math.hpp"
#include "engine/core/result.hpp"

namespace neritic::scene {

// Labels are 16 bit and 0 is nothing.
inline constexpr std::size_t kMaxInstances = 65535;

// object_from_copy of x, y, z [metres], yaw [degrees, default 0], scale [default 1].
Mat4 copy_from_row(const std::vector<double>& row);

// Rows of three to five numbers with commas between; '#' starts a comment, and a first line of
// words is a heading.
Result<std::vector<Mat4>> parse_copies(std::string_view text, const std::string& name);
Result<std::vector<Mat4>> read_copies_file(const std::filesystem::path& path);

}  // namespace neritic::scene
