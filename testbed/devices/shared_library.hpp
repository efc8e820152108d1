// A library that is loaded while the program runs, where it is installed: nothing is linked, and
// nobody who has no such device needs it. Closed with the object; stays in memory. One thread.
#pragma once

#include <string>
#include <utility>

#include "engine/core/result.hpp"

namespace neritic::testbed {

class SharedLibrary {
 public:
  // The first of the names, separated by spaces, that loads. kUnsupported: none does; package: what
  // to install.
  static Result<SharedLibrary> load(const std::string& names, const std::string& package);
  SharedLibrary(SharedLibrary&& other) noexcept : handle_(std::exchange(other.handle_, nullptr)) {}
  SharedLibrary& operator=(SharedLibrary&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }
  ~SharedLibrary();

  // Finds a function; notes the first that is not there.
  template <class Function>
  void find(const char* name, Function*& function) {
    function = reinterpret_cast<Function*>(symbol(name));
  }
  // kUnsupported if a function was not there.
  Status complete() const;

 private:
  explicit SharedLibrary(void* handle) : handle_(handle) {}
  void* symbol(const char* name);
  void* handle_;
  std::string missing_;
};

}  // namespace neritic::testbed
