// Result<T>: a value, or what went wrong in one sentence. For everything that can fail from
// outside (a file, a flag, a packet, a device). A bug of ours is a NERITIC_CHECK instead.
// Any thread; a Result is a plain value.
#pragma once

#include <fmt/format.h>

#include <memory>
#include <string>
#include <type_traits>
#include <utility>

#include "engine/core/check.hpp"

namespace neritic {

enum class ErrorCode {
  kBadInput,     // a file, flag or scene key is wrong: exit status 2
  kNoDevice,     // no Vulkan device, or none that fits
  kUnsupported,  // the device lacks something that was asked for
  kOutOfMemory,
  kDeviceLost,
  kIo,           // could not write, disk full
  kInterrupted,  // the user stopped it: exit status 130, as shells have it
  kInternal,     // a bug of ours that is returned instead of aborting
};

struct Error {
  ErrorCode code = ErrorCode::kBadInput;
  // One line without a trailing newline: what (file, field or line), what was found, what is
  // accepted.
  std::string message;
};

// The program's exit status for an error: 2 for bad input or usage, 130 for what the user stopped,
// 1 for everything else.
inline int exit_status(ErrorCode code) {
  if (code == ErrorCode::kInterrupted) return 130;
  return code == ErrorCode::kBadInput ? 2 : 1;
}

// Ends the program if a precondition of Result is broken.
[[noreturn]] inline void value_of_error(const Error& error) {
  check_failed(__FILE__, __LINE__, "Result has a value", error.message);
}
[[noreturn]] inline void error_of_value() {
  check_failed(__FILE__, __LINE__, "Result has an error", "");
}

// Not a std::variant: its templates would cost a twentieth of the time to compile Neritic.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : ok_(true) { std::construct_at(&value_, std::move(value)); }
  Result(Error error) : ok_(false) { std::construct_at(&error_, std::move(error)); }
  Result(Result&& other) noexcept(std::is_nothrow_move_constructible_v<T>) : ok_(other.ok_) {
    take(std::move(other));
  }
  Result(const Result& other) requires std::is_copy_constructible_v<T> : ok_(other.ok_) {
    if (ok_)
      std::construct_at(&value_, other.value_);
    else
      std::construct_at(&error_, other.error_);
  }
  Result& operator=(Result other) noexcept(std::is_nothrow_move_constructible_v<T>) {
    destroy();
    ok_ = other.ok_;
    take(std::move(other));
    return *this;
  }
  ~Result() { destroy(); }

  bool ok() const { return ok_; }
  explicit operator bool() const { return ok_; }
  // Preconditions: ok() for value(), !ok() for error().
  T& value() & {
    check_value();
    return value_;
  }
  const T& value() const& {
    check_value();
    return value_;
  }
  T&& value() && {
    check_value();
    return std::move(value_);
  }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  const Error& error() const {
    if (ok_) [[unlikely]]
      error_of_value();
    return error_;
  }

 private:
  void check_value() const {
    if (!ok_) [[unlikely]]
      value_of_error(error_);
  }
  void take(Result&& other) {
    if (ok_)
      std::construct_at(&value_, std::move(other.value_));
    else
      std::construct_at(&error_, std::move(other.error_));
  }
  void destroy() {
    if (ok_)
      value_.~T();
    else
      error_.~Error();
  }

  union {
    T value_;
    Error error_;
  };
  bool ok_;
};

template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Error error) : error_(std::move(error)), ok_(false) {}
  bool ok() const { return ok_; }
  explicit operator bool() const { return ok_; }
  const Error& error() const {
    if (ok_) [[unlikely]]
      error_of_value();
    return error_;
  }

 private:
  Error error_;
  bool ok_ = true;
};

using Status = Result<void>;

// bad_input("{}: width {} is not positive", path, width): an Error with exit status 2.
template <class... Args>
Error bad_input(fmt::format_string<Args...> format, Args&&... args) {
  return {ErrorCode::kBadInput, fmt::format(format, std::forward<Args>(args)...)};
}
template <class... Args>
Error failure(ErrorCode code, fmt::format_string<Args...> format, Args&&... args) {
  return {code, fmt::format(format, std::forward<Args>(args)...)};
}

}  // namespace neritic

#define NERITIC_CONCAT_INNER(a, b) a##b
#define NERITIC_CONCAT(a, b) NERITIC_CONCAT_INNER(a, b)
// NERITIC_TRY(auto x, f()): x is f()'s value, or the enclosing function returns f()'s error.
#define NERITIC_TRY(declaration, expression) \
  NERITIC_TRY_INNER(declaration, expression, NERITIC_CONCAT(result_, __LINE__))
#define NERITIC_TRY_INNER(declaration, expression, name) \
  auto name = (expression);                              \
  if (!name.ok()) return name.error();                   \
  declaration = std::move(name).value()
// The same for a Status.
#define NERITIC_TRY_STATUS(expression)                                                        \
  do {                                                                                        \
    if (auto status_of_try = (expression); !status_of_try.ok()) return status_of_try.error(); \
  } while (false)
