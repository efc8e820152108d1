// Makes the bytes of an MCAP file while a run goes on: chunks compressed by zstd, each with a CRC
// and an index of its messages, then a summary with the indexes of everything. A file that ends
// after any whole chunk reads up to there. The owner writes what take() gives. One thread.
#pragma once

#include <optional>
#include <utility>

#include "engine/recording/mcap_out.hpp"

namespace neritic::recording {

class McapWriter final : public McapOut {
 public:
  // A chunk is closed at this size; end_chunk() closes it sooner. After so many bytes schemas and
  // channels come again, so that a reader that lost them goes on.
  static constexpr std::size_t kChunk_bytes = std::size_t{1} << 20;

  // profile: "ros2"; library: the program with its version. level: of zstd, 1 to 19; 0: chunks
  // are not compressed.
  McapWriter(std::string_view profile, std::string_view library, int level = 3);

  std::uint16_t add_schema(McapSchema schema) override;
  std::uint16_t add_channel(McapChannel channel) override;
  void message(const McapMessage& message) override;
  void attachment(const McapAttachment& attachment) override;
  void metadata(const McapMetadata& metadata) override;
  // Messages that no chunk has yet are in the bytes from now on.
  void end_chunk();
  // Uncompressed bytes of messages that no chunk has yet.
  std::size_t open_bytes() const { return chunk_.size(); }
  // The summary. Nothing comes after it.
  void finish();
  // The bytes made since the last call.
  std::string take() { return std::exchange(out_, {}); }

 private:
  struct ChunkFacts {
    std::uint64_t first_ns = 0, last_ns = 0, offset = 0, length = 0, index_length = 0;
    std::uint64_t compressed = 0, uncompressed = 0;
    std::map<std::uint16_t, std::uint64_t> index_offsets;
    bool packed = true;
  };
  void record(McapOp op, std::string_view content);
  void count();

  int level_;
  std::string out_;
  std::uint64_t written_ = 0;   // bytes that were counted into the CRC
  std::size_t counted_ = 0;     // of out_
  std::uint32_t data_crc_ = 0;  // of all bytes so far
  std::vector<McapSchema> schemas_;
  std::vector<McapChannel> channels_;
  // In the file; and among the last kChunk_bytes of it.
  std::vector<bool> schema_in_file_, channel_in_file_, schema_told_, channel_told_;
  std::size_t since_told_bytes_ = 0;
  std::string chunk_;
  std::uint64_t first_ns_ = 0, last_ns_ = 0;
  bool any_in_chunk_ = false;
  // Time and place in the chunk of each message, by channel.
  std::map<std::uint16_t, std::vector<std::pair<std::uint64_t, std::uint64_t>>> places_;
  std::vector<ChunkFacts> chunks_;
  std::vector<std::pair<McapOp, std::string>> side_indexes_;  // of attachments and metadata
  std::vector<std::uint64_t> counts_;                         // messages of each channel
  std::uint64_t messages_ = 0, start_ns_ = 0, end_ns_ = 0;
  std::uint32_t attachments_ = 0, metadatas_ = 0;
};

}  // namespace neritic::recording
