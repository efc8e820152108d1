#include "tests/fakes/openxr/xr.hpp"

namespace neritic::fakes {

#define NERITIC_XR_CASE(name, value) \
  case name:                         \
    return #name;
#define NERITIC_XR_NAME(type)                                     \
  std::string name_of(type value) {                               \
    switch (value) {                                              \
      XR_LIST_ENUM_##type(NERITIC_XR_CASE) default                \
          : return std::to_string(static_cast<long long>(value)); \
    }                                                             \
  }
NERITIC_XR_NAME(XrStructureType)
NERITIC_XR_NAME(XrResult)
NERITIC_XR_NAME(XrSessionState)
NERITIC_XR_NAME(XrObjectType)
NERITIC_XR_NAME(XrViewConfigurationType)
#undef NERITIC_XR_NAME
#undef NERITIC_XR_CASE

}  // namespace neritic::fakes
