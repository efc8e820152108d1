// Arrays of several kinds of plain structs in one block of memory: the state of a scene, whose
// number of participants is known when it is built. A copy is one copy of bytes, and assigning a
// block of the same counts allocates nothing and leaves references to its items valid. One thread
// at a time, as any value.
//
//   class FleetState : public Block<Boat, Buoy> { ... };   // FleetState({3, 10})
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

namespace neritic::sim {

template <class... Parts>
class Block {
  static_assert((std::is_trivially_copyable_v<Parts> && ...));
  static_assert(((alignof(Parts) <= 8 && sizeof(Parts) % 8 == 0) && ...));

 public:
  static constexpr std::size_t kKinds = sizeof...(Parts);
  using Counts = std::array<std::uint64_t, kKinds>;

  Block() : Block(Counts{}) {}
  // Each item as its type's default makes it. There are no moves: they would leave blocks without
  // the memory that their counts promise.
  explicit Block(const Counts& counts) : counts_(counts), bytes_(offset_of(kKinds)) {
    (std::uninitialized_value_construct_n(part<Parts>().data(), part<Parts>().size()), ...);
  }
  Block(const Block&) = default;
  Block& operator=(const Block&) = default;

  // All items of a kind.
  template <class Part>
  std::span<Part> part() {
    return {reinterpret_cast<Part*>(bytes_.data() + offset_of(kind_of<Part>())),
            counts_[kind_of<Part>()]};
  }
  template <class Part>
  std::span<const Part> part() const {
    return {reinterpret_cast<const Part*>(bytes_.data() + offset_of(kind_of<Part>())),
            counts_[kind_of<Part>()]};
  }

  const Counts& counts() const { return counts_; }
  // All items, kind by kind.
  std::span<const std::byte> bytes() const { return bytes_; }
  std::span<std::byte> bytes() { return bytes_; }

 private:
  // Where the items of a kind begin.
  std::size_t offset_of(std::size_t end) const {
    std::size_t offset = 0, kind = 0;
    ((offset += kind < end ? counts_[kind] * sizeof(Parts) : 0, ++kind), ...);
    return offset;
  }
  template <class Part>
  static constexpr std::size_t kind_of() {
    constexpr bool same[] = {std::is_same_v<Part, Parts>...};
    std::size_t kind = 0;
    while (!same[kind]) ++kind;  // a kind that the block lacks does not compile
    return kind;
  }
  Counts counts_;
  std::vector<std::byte> bytes_;  // aligned as operator new aligns: 16
};

}  // namespace neritic::sim
