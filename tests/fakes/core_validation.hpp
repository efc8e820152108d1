// OpenXR's core validation layer (Debian package openxr-layer-corevalidation) on every instance
// that is made while this lives; what it says is kept.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/support/support.hpp"

namespace neritic::fakes {

inline constexpr const char* kCoreValidation = "XR_APILAYER_LUNARG_core_validation";

class CoreValidation {
 public:
  CoreValidation() {
    setenv("XR_ENABLE_API_LAYERS", kCoreValidation, 1);
    setenv("XR_CORE_VALIDATION_EXPORT_TYPE", "text", 1);
    setenv("XR_CORE_VALIDATION_FILE_NAME", file().c_str(), 1);
  }
  ~CoreValidation() {
    unsetenv("XR_ENABLE_API_LAYERS");
    unsetenv("XR_CORE_VALIDATION_EXPORT_TYPE");
    unsetenv("XR_CORE_VALIDATION_FILE_NAME");
  }
  CoreValidation(const CoreValidation&) = delete;
  CoreValidation& operator=(const CoreValidation&) = delete;
  static bool installed() {
    return std::filesystem::exists(
        "/usr/share/openxr/1/api_layers/explicit.d/"
        "XrApiLayer_core_validation.x86_64-linux-gnu.json");
  }
  // All that the layer said; whole once the instances are destroyed.
  std::string messages() const {
    std::ifstream in(file());
    return {std::istreambuf_iterator<char>(in), {}};
  }

 private:
  std::string file() const { return (folder_ / "validation.txt").string(); }
  test::ScratchFolder folder_;
};

}  // namespace neritic::fakes
