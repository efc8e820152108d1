// Chunks of an MCAP file: their records, what is packed in them, and where the next one begins
// after bytes that cannot be read. Pure functions; any thread.
#pragma once

#include <optional>

#include "engine/recording/mcap_reader.hpp"

namespace neritic::recording {

// A record's kind and the length of what follows its head.
inline constexpr std::size_t kRecordHead_bytes = 9;
struct Head {
  McapOp op{};
  std::uint64_t length = 0;
};

// Precondition: so many bytes.
Head head_of(std::span<const std::byte> bytes);

// A chunk's record.
struct Chunk {
  std::uint64_t size = 0;  // unpacked
  std::uint32_t crc = 0;   // 0: it has none
  std::string compression;
  std::span<const std::byte> packed;
};
// Nothing: the record is no whole chunk. Borrows content.
std::optional<Chunk> chunk_of(std::span<const std::byte> content);
// Unpacks the chunk's records into `out`. Says what is wrong with them; empty: nothing is.
std::string unpack(const Chunk& chunk, std::vector<std::byte>& out);

// Where the next whole chunk with the CRC that it says begins, by a look at every byte from there
// on.
Result<std::optional<std::uint64_t>> next_chunk(McapSource& source, std::uint64_t from);

}  // namespace neritic::recording
