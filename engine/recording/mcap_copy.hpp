// Copies what is good of an MCAP file into a new one with a whole summary. One thread.
#pragma once

#include <map>

#include "engine/recording/mcap_out.hpp"
#include "engine/recording/mcap_reader.hpp"

namespace neritic::recording {

// Gives an out all that it visits, under ids of the out's.
class McapCopy : public McapVisitor {
 public:
  explicit McapCopy(McapOut& out) : out_(out) {}
  Status schema(std::uint16_t id, const McapSchema& schema) override;
  Status channel(std::uint16_t id, const McapChannel& channel) override;
  Status message(const McapMessage& message) override;
  Status attachment(const McapAttachment& attachment) override;
  Status metadata(const McapMetadata& metadata) override;

 private:
  McapOut& out_;
  std::map<std::uint16_t, std::uint16_t> schemas_, channels_;  // of the out, by the file's
};

// Writes the copy to a file, which takes its name when it is whole. kBadInput as read_mcap, kIo;
// kUnsupported, and no file, if no message of a damaged one is good.
Result<McapReport> repair_mcap(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace neritic::recording
