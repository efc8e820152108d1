// Reads an MCAP file from its start to its end, or to where it was cut off, record by record, in
// bounded memory. Damage is named; the rest is read. Any bytes are safe. One thread.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "engine/core/result.hpp"
#include "engine/recording/mcap.hpp"

namespace neritic::recording {

// Where the bytes are.
class McapSource {
 public:
  virtual ~McapSource() = default;
  virtual std::uint64_t size() const = 0;
  // kIo where they cannot be read. Precondition: they are inside of size().
  virtual Status read(std::uint64_t at, std::span<std::byte> out) = 0;
};
// kBadInput where the file is missing or no plain file.
Result<std::unique_ptr<McapSource>> open_mcap(const std::filesystem::path& path);
// Borrows the bytes.
std::unique_ptr<McapSource> mcap_of(std::span<const std::byte> bytes);

// Gets all that is found, in the order of the file. A schema and a channel come before the messages
// that need them; the summary's copies are left out, but where the others were damaged and the
// reading goes on. An Error ends the reading.
class McapVisitor {
 public:
  virtual ~McapVisitor() = default;
  virtual Status header(const std::string& profile, const std::string& library);
  virtual Status schema(std::uint16_t id, const McapSchema& schema);
  virtual Status channel(std::uint16_t id, const McapChannel& channel);
  virtual Status message(const McapMessage& message);
  virtual Status attachment(const McapAttachment& attachment);
  virtual Status metadata(const McapMetadata& metadata);
};

struct McapReport {
  // It has its end, and its summary agrees with what was found.
  bool whole = false;
  // One line each, "at byte 4711: a chunk whose CRC differs"; the first few of `damages`.
  std::vector<std::string> damage;
  std::uint64_t damages = 0;
  std::uint64_t size_bytes = 0, chunks = 0, messages = 0, unpacked_bytes = 0;
  std::uint64_t first_ns = 0, last_ns = 0;  // of the messages' log times
};

inline constexpr std::uint64_t kMostChunk_bytes = std::uint64_t{1} << 28;   // unpacked
inline constexpr std::uint64_t kMostRecord_bytes = std::uint64_t{1} << 30;  // of one record

// kStop: what lies behind the first damage is not read, so that nothing is missing in between.
enum class AfterDamage { kStop, kGoOn };
// kBadInput if it does not begin as an MCAP file; name stands in messages.
Result<McapReport> read_mcap(McapSource& source, const std::string& name, McapVisitor& visitor,
                             AfterDamage after = AfterDamage::kStop);

}  // namespace neritic::recording
