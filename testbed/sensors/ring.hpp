// Values that frames in flight borrow. A Pin borrows one for as long as it lives; a Ring has as
// many values as were ever borrowed at once, up to a bound. Rendering thread only.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/core/check.hpp"
#include "engine/core/refusal.hpp"
#include "engine/core/result.hpp"

namespace neritic::testbed {

template <class T>
struct PinSlot {
  T value{};
  std::uint32_t pins = 0;
};

// Keeps a slot's value as it is. The slot must outlive it.
template <class T>
class Pin {
 public:
  Pin() = default;
  explicit Pin(PinSlot<T>& slot) : slot_(&slot) { ++slot.pins; }
  Pin(Pin&& other) noexcept : slot_(std::exchange(other.slot_, nullptr)) {}
  Pin& operator=(Pin&& other) noexcept {
    std::swap(slot_, other.slot_);
    return *this;
  }
  ~Pin() {
    if (slot_) --slot_->pins;
  }
  explicit operator bool() const { return slot_ != nullptr; }
  T& operator*() const { return slot_->value; }
  T* operator->() const { return &slot_->value; }

 private:
  PinSlot<T>* slot_ = nullptr;
};

template <class T>
class Ring {
 public:
  // Frames that may hold a value of one ring at once.
  static constexpr std::size_t kMost = 8;

  Ring() = default;
  Ring(Ring&&) = default;
  ~Ring() {
    for (const auto& slot : slots_)
      NERITIC_CHECK(slot->pins == 0, "a ring dies while {} frames hold a value", slot->pins);
  }

  // Borrows a value that nobody else has: one that fits(value), else one that make() makes. name:
  // whose values they are, for the error at the bound.
  template <class Fits, class Make>
  Result<Pin<T>> take(const std::string& name, Fits&& fits, Make&& make) {
    PinSlot<T>* free = nullptr;
    for (const auto& slot : slots_) {
      if (slot->pins > 0) continue;
      if (fits(slot->value)) return Pin<T>(*slot);
      free = slot.get();
    }
    if (!free && slots_.size() == kMost)
      return failure(ErrorCode::kUnsupported, "{}: read-back: {}", name,
                     found_accepted(fmt::format("{} frames that hold one", kMost),
                                    fmt::format("at most {} frames at once", kMost)));
    NERITIC_TRY(T value, make());
    if (!free) free = slots_.emplace_back(std::make_unique<PinSlot<T>>()).get();
    free->value = std::move(value);
    return Pin<T>(*free);
  }
  std::size_t size() const { return slots_.size(); }

 private:
  std::vector<std::unique_ptr<PinSlot<T>>> slots_;
};

}  // namespace neritic::testbed
