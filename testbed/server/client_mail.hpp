// All that one client has not been given yet, in bounded queues: a slow client loses the oldest
// items, counted. The network's thread.
#pragma once

#include <deque>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <set>

#include "engine/net/array_ring.hpp"
#include "testbed/server/hand_off.hpp"

namespace neritic::testbed {

// The newest reading of each stream, and when it changed.
class NewestTable {
 public:
  explicit NewestTable(std::size_t streams) : rows_(streams) {}
  void put(const Reading& reading);
  // Those that changed after a version; version becomes the newest.
  std::vector<Reading> after(std::uint64_t& version) const;
  std::uint64_t version() const { return version_; }

 private:
  struct Row {
    Reading reading;
    std::uint64_t version = 0;
  };
  std::vector<Row> rows_;
  std::uint64_t version_ = 0;
};

// A message to a client as it is sent: the map, then its arrays.
struct Outgoing {
  std::vector<std::vector<std::byte>> frames;
};

class ClientMail {
 public:
  static constexpr std::size_t kMostKept = 8192;             // readings
  static constexpr std::size_t kMostImageBytes = 48u << 20;  // also of one message

  // Streams of which it wants each reading, and images.
  std::set<std::uint32_t> kept;
  std::map<std::uint32_t, bool> images;  // true: each; false: the newest is enough
  bool shared = false;                   // it reads the ring
  std::uint64_t seen = 0;                // version of the newest readings that it has
  std::size_t asked = 0;                 // requests of it that the simulation has
  struct Observe {
    std::uint64_t id = 0;
    TimeNs until_ns = 0;
  };
  std::optional<Observe> observe;  // waits for something new

  void put(const Reading& reading);
  // position: in the ring, where it fits there.
  void put(const WorldImage& image, std::optional<std::uint64_t> position);
  bool any(const NewestTable& newest) const;
  // Moves all that is new into the message.
  void take(const NewestTable& newest, nlohmann::json& map, Outgoing& message);

 private:
  struct Image {
    std::uint32_t stream = 0;
    std::vector<std::byte> facts;  // packed
    std::optional<std::uint64_t> position;
    std::vector<std::byte> bytes;  // where it is not in the ring
  };
  std::deque<Reading> readings_;
  std::deque<Image> images_;
  std::size_t image_bytes_ = 0;
  std::uint64_t lost_readings_ = 0, lost_images_ = 0;
};

// Readings as rows of numbers, little-endian: u32 stream, u32 count, u64 sequence, i64 stamp_ns,
// i64 arrival_ns, f64 values[columns]. Adds the array; gives {"rows", "columns", "frame"}.
nlohmann::json add_rows(std::span<const Reading> readings, Outgoing& message);

}  // namespace neritic::testbed
