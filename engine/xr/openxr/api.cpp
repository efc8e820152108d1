#include "engine/xr/openxr/api.hpp"

#include <dlfcn.h>
#include <openxr/openxr_reflection.h>

#include <cstdlib>

namespace neritic::xr::openxr {
namespace {

constexpr const char* kLoader = "libopenxr_loader.so.1";

template <class Function>
XrResult read(PFN_xrGetInstanceProcAddr get, XrInstance instance, const char* name,
              Function& function) {
  PFN_xrVoidFunction found = nullptr;
  const XrResult result = get(instance, name, &found);
  function = XR_SUCCEEDED(result) ? reinterpret_cast<Function>(found) : nullptr;
  return result;
}

}  // namespace

Result<Functions> instance_functions(PFN_xrGetInstanceProcAddr get, XrInstance instance) {
  Functions table;
#define NERITIC_XR_REQUIRE(name)                                                          \
  if (const XrResult result = read(get, instance, "xr" #name, table.name); !table.name)   \
    return failure(ErrorCode::kUnsupported, "the OpenXR runtime has no xr" #name " ({})", \
                   name_of(result));
  NERITIC_XR_FUNCTIONS(NERITIC_XR_REQUIRE)
#undef NERITIC_XR_REQUIRE
#define NERITIC_XR_READ(name) (void)read(get, instance, "xr" #name, table.name);
  NERITIC_XR_OPTIONAL_FUNCTIONS(NERITIC_XR_READ)
#undef NERITIC_XR_READ
  return table;
}

Result<Loader> load_loader() {
  // It prints several lines for each thing that it does not find; we say one. A user's choice
  // stays.
  ::setenv("XR_LOADER_DEBUG", "none", 0);
  // Not unloaded: layers and runtimes leave threads and statics behind that would not survive it.
  void* library = ::dlopen(kLoader, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  if (!library)
    return failure(ErrorCode::kNoDevice,
                   "no OpenXR loader ({}): install the Debian package libopenxr-loader1", kLoader);
  Loader loader;
  loader.get =
      reinterpret_cast<PFN_xrGetInstanceProcAddr>(::dlsym(library, "xrGetInstanceProcAddr"));
  if (!loader.get) return failure(ErrorCode::kNoDevice, "{} has no xrGetInstanceProcAddr", kLoader);
  (void)read(loader.get, XR_NULL_HANDLE, "xrEnumerateInstanceExtensionProperties",
             loader.extensions);
  (void)read(loader.get, XR_NULL_HANDLE, "xrEnumerateApiLayerProperties", loader.layers);
  (void)read(loader.get, XR_NULL_HANDLE, "xrCreateInstance", loader.create);
  if (!loader.extensions || !loader.layers || !loader.create)
    return failure(ErrorCode::kNoDevice, "{} lacks functions of OpenXR 1.0", kLoader);
  return loader;
}

std::string name_of(XrResult result) {
  switch (result) {
#define NERITIC_XR_NAME(name, value) \
  case value:                        \
    return #name;
    XR_LIST_ENUM_XrResult(NERITIC_XR_NAME)
#undef NERITIC_XR_NAME
  }
  return fmt::format("XrResult {}", static_cast<int>(result));
}

}  // namespace neritic::xr::openxr
