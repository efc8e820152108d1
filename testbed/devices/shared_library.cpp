#include "testbed/devices/shared_library.hpp"

#include <dlfcn.h>

#include <sstream>

namespace neritic::testbed {

Result<SharedLibrary> SharedLibrary::load(const std::string& names, const std::string& package) {
  std::istringstream words(names);
  for (std::string name; words >> name;)
    // It stays in memory when it is closed: threads of its own may still end.
    if (void* handle = ::dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE))
      return SharedLibrary(handle);
  return failure(ErrorCode::kUnsupported, "no {} on this machine; install {}",
                 names.substr(0, names.find(' ')), package);
}

SharedLibrary::~SharedLibrary() {
  if (handle_) ::dlclose(handle_);
}

void* SharedLibrary::symbol(const char* name) {
  void* found = ::dlsym(handle_, name);
  if (!found && missing_.empty()) missing_ = name;
  return found;
}

Status SharedLibrary::complete() const {
  if (missing_.empty()) return {};
  return failure(ErrorCode::kUnsupported, "the library has no {}: too old", missing_);
}

}  // namespace neritic::testbed
