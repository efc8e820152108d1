// The newest value, handed from one thread to another without waiting: of three slots the producer
// writes one, the consumer reads one, and one lies between them; each side swaps its own with that
// in the middle. One producer thread, one consumer thread; both wait-free. A value's assignment
// must not allocate where both sides have the same size, as of plain structs and blocks.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace neritic::sim {

template <class T>
class TripleBuffer {
 public:
  // All slots get the value, so that publish() finds memory of the right size.
  explicit TripleBuffer(const T& initial) : slots_{{{initial}, {initial}, {initial}}} {}
  TripleBuffer(const TripleBuffer&) = delete;
  TripleBuffer& operator=(const TripleBuffer&) = delete;

  // Producer: writes the draft, whose content is of any earlier time, and publishes it.
  T& draft() { return slots_[back_].value; }
  void publish() { back_ = middle_.exchange(back_ | kNew, std::memory_order_acq_rel) & kIndex; }
  void publish(const T& value) {
    draft() = value;
    publish();
  }

  // Consumer: true where something new was published since the last call; newest() is that then.
  bool update() {
    if ((middle_.load(std::memory_order_relaxed) & kNew) == 0) return false;
    front_ = middle_.exchange(front_, std::memory_order_acq_rel) & kIndex;
    return true;
  }
  // Consumer: valid until the next update().
  const T& newest() const { return slots_[front_].value; }

 private:
  static constexpr std::uint32_t kIndex = 3, kNew = 4;
  // A line of its own each, so that neither side's writes slow the other's reads.
  struct alignas(64) Slot {
    T value;
  };
  std::array<Slot, 3> slots_;
  alignas(64) std::atomic<std::uint32_t> middle_{1};
  alignas(64) std::uint32_t back_ = 2;   // producer's
  alignas(64) std::uint32_t front_ = 0;  // consumer's
};

}  // namespace neritic::sim
