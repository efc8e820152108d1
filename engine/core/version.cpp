#include "engine/core/version.hpp"

namespace neritic {

std::string_view program_version() {
  return "neritic " NERITIC_VERSION;
}

}  // namespace neritic
