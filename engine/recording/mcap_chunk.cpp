#include "engine/recording/mcap_chunk.hpp"

#include <fmt/format.h>
#include <zstd.h>

#include <algorithm>

#include "engine/core/text.hpp"
#include "engine/recording/mcap_bytes.hpp"

namespace neritic::recording {
namespace {

// A whole chunk, with the CRC that it says.
Result<bool> is_chunk(McapSource& source, std::uint64_t at) {
  std::byte bytes[kRecordHead_bytes];
  NERITIC_TRY_STATUS(source.read(at, bytes));
  const Head head = head_of(bytes);
  if (head.length > kMostRecord_bytes || head.length > source.size() - at - kRecordHead_bytes)
    return false;
  std::vector<std::byte> content(static_cast<std::size_t>(head.length)), unpacked;
  NERITIC_TRY_STATUS(source.read(at + kRecordHead_bytes, content));
  const auto chunk = chunk_of(content);
  return chunk && (chunk->crc != 0 || !chunk->compression.empty()) &&
         unpack(*chunk, unpacked).empty();
}

}  // namespace

Head head_of(std::span<const std::byte> bytes) {
  McapCursor cursor(bytes.first(kRecordHead_bytes));
  const auto op = static_cast<McapOp>(cursor.number<std::uint8_t>());
  return {op, cursor.number<std::uint64_t>()};
}

std::optional<Chunk> chunk_of(std::span<const std::byte> content) {
  McapCursor cursor(content);
  cursor.take(16);  // times
  Chunk chunk;
  chunk.size = cursor.number<std::uint64_t>();
  chunk.crc = cursor.number<std::uint32_t>();
  chunk.compression = cursor.text();
  chunk.packed = cursor.take(cursor.number<std::uint64_t>());
  return cursor.whole() && cursor.left() == 0 ? std::optional(chunk) : std::nullopt;
}

std::string unpack(const Chunk& chunk, std::vector<std::byte>& out) {
  if (chunk.size > kMostChunk_bytes)
    return fmt::format("a chunk of {} bytes; accepted: up to {}", chunk.size, kMostChunk_bytes);
  if (chunk.compression.empty()) {
    if (chunk.packed.size() != chunk.size) return "a chunk with another size than it says";
    out.assign(chunk.packed.begin(), chunk.packed.end());
  } else if (chunk.compression == "zstd") {
    constexpr const char* kWrong = "a chunk that zstd cannot unpack";
    // Ours say their size; then nothing is reserved that is not there.
    const auto inside = ZSTD_getFrameContentSize(chunk.packed.data(), chunk.packed.size());
    if (inside == ZSTD_CONTENTSIZE_ERROR ||
        (inside != ZSTD_CONTENTSIZE_UNKNOWN && inside != chunk.size))
      return kWrong;
    out.resize(static_cast<std::size_t>(chunk.size));
    const std::size_t got =
        ZSTD_decompress(out.data(), out.size(), chunk.packed.data(), chunk.packed.size());
    if (ZSTD_isError(got) || got != chunk.size) return kWrong;
  } else {
    return fmt::format("a chunk with the compression '{}'; accepted: zstd or none",
                       printable(chunk.compression));
  }
  if (chunk.crc != 0 && crc_of(out) != chunk.crc) return "a chunk whose CRC differs";
  return "";
}

Result<std::optional<std::uint64_t>> next_chunk(McapSource& source, std::uint64_t from) {
  // A chunk's head to the length of the name of its compression, which has up to four letters.
  constexpr std::size_t kName = kRecordHead_bytes + 28, kLeast = kName + 4 + 8;
  constexpr std::size_t kBlock = std::size_t{1} << 20;
  std::vector<std::byte> block;
  while (from + kLeast <= source.size()) {
    block.resize(
        static_cast<std::size_t>(std::min<std::uint64_t>(kBlock + kLeast, source.size() - from)));
    NERITIC_TRY_STATUS(source.read(from, block));
    for (std::size_t i = 0; i + kLeast <= block.size(); ++i) {
      if (block[i] != static_cast<std::byte>(McapOp::kChunk)) continue;
      const std::uint64_t length = head_of(std::span(block).subspan(i)).length;
      if (length > source.size() - from - i - kRecordHead_bytes) continue;
      McapCursor name(std::span<const std::byte>(block).subspan(i + kName));
      if (name.number<std::uint32_t>() > 4) continue;
      NERITIC_TRY(const bool whole, is_chunk(source, from + i));
      if (whole) return std::optional(from + i);
    }
    from += block.size() - kLeast + 1;
  }
  return std::optional<std::uint64_t>();
}

}  // namespace neritic::recording
