// The program's name and version, "neritic 0.1.0": what files say made them. Any thread.
#pragma once

#include <string_view>

namespace neritic {

std::string_view program_version();

}  // namespace neritic
