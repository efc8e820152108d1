// In place of engine/xr/openxr where OpenXR's headers were not there at build time.
#include "engine/xr/openxr/headset.hpp"

namespace neritic::xr {
namespace {

Error absent() {
  return failure(ErrorCode::kNoDevice,
                 "this build has no OpenXR: install the Debian package libopenxr-dev and build "
                 "again");
}

}  // namespace

Result<std::unique_ptr<Headset>> Headset::connect(const HeadsetOptions&) {
  return absent();
}

Result<HeadsetInfo> examine_headset() {
  return absent();
}

}  // namespace neritic::xr
