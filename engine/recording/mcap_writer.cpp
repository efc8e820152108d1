#include "engine/recording/mcap_writer.hpp"

#include <zstd.h>

#include <algorithm>

#include "engine/core/check.hpp"
#include "engine/recording/mcap_bytes.hpp"

namespace neritic::recording {
namespace {

void put_record(std::string& out, McapOp op, std::string_view content) {
  put(out, static_cast<std::uint8_t>(op));
  put(out, static_cast<std::uint64_t>(content.size()));
  out += content;
}

std::string schema_content(std::size_t id, const McapSchema& schema) {
  std::string out;
  put(out, static_cast<std::uint16_t>(id));
  put_text(out, schema.name);
  put_text(out, schema.encoding);
  put_text(out, schema.data);
  return out;
}

std::string channel_content(std::size_t id, const McapChannel& channel) {
  std::string out;
  put(out, static_cast<std::uint16_t>(id));
  put(out, channel.schema);
  put_text(out, channel.topic);
  put_text(out, channel.encoding);
  put_words(out, channel.metadata);
  return out;
}

std::string compressed(std::string_view bytes, int level) {
  std::string out(ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t size = ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), level);
  NERITIC_CHECK(!ZSTD_isError(size), "zstd: {}", ZSTD_getErrorName(size));
  out.resize(size);
  return out;
}

}  // namespace

McapWriter::McapWriter(std::string_view profile, std::string_view library, int level)
    : level_(level) {
  out_ += kMcapMagic;
  std::string header;
  put_text(header, profile);
  put_text(header, library);
  record(McapOp::kHeader, header);
}

// Brings the CRC of the data section up to the bytes that were made.
void McapWriter::count() {
  const std::string_view more = std::string_view(out_).substr(counted_);
  data_crc_ = crc_of(more, data_crc_);
  written_ += more.size();
  counted_ = out_.size();
}

void McapWriter::record(McapOp op, std::string_view content) {
  if (out_.empty()) counted_ = 0;
  put_record(out_, op, content);
  count();
}

std::uint16_t McapWriter::add_schema(McapSchema schema) {
  NERITIC_CHECK(schemas_.size() < kMostSchemas, "{} schemas", schemas_.size());
  schemas_.push_back(std::move(schema));
  schema_in_file_.push_back(false);
  schema_told_.push_back(false);
  return static_cast<std::uint16_t>(schemas_.size());  // from 1
}

std::uint16_t McapWriter::add_channel(McapChannel channel) {
  NERITIC_CHECK(channels_.size() < kMostChannels && channel.schema <= schemas_.size(),
                "{} channels, schema {} of {}", channels_.size(), channel.schema, schemas_.size());
  channels_.push_back(std::move(channel));
  channel_in_file_.push_back(false);
  channel_told_.push_back(false);
  counts_.push_back(0);
  return static_cast<std::uint16_t>(channels_.size() - 1);
}

void McapWriter::message(const McapMessage& message) {
  NERITIC_CHECK(message.channel < channels_.size(), "channel {} of {}", message.channel,
                channels_.size());
  const McapChannel& channel = channels_[message.channel];
  // In the first chunk that needs them, so that a file cut off behind it reads.
  if (channel.schema > 0 && !schema_told_[channel.schema - 1u]) {
    put_record(chunk_, McapOp::kSchema,
               schema_content(channel.schema, schemas_[channel.schema - 1u]));
    schema_in_file_[channel.schema - 1u] = schema_told_[channel.schema - 1u] = true;
  }
  if (!channel_told_[message.channel]) {
    put_record(chunk_, McapOp::kChannel, channel_content(message.channel, channel));
    channel_in_file_[message.channel] = channel_told_[message.channel] = true;
  }
  places_[message.channel].emplace_back(message.log_ns, chunk_.size());
  put(chunk_, static_cast<std::uint8_t>(McapOp::kMessage));
  put(chunk_, static_cast<std::uint64_t>(22 + message.data.size()));
  put(chunk_, message.channel);
  put(chunk_, message.sequence);
  put(chunk_, message.log_ns);
  put(chunk_, message.publish_ns);
  put_bytes(chunk_, message.data);

  first_ns_ = any_in_chunk_ ? std::min(first_ns_, message.log_ns) : message.log_ns;
  last_ns_ = any_in_chunk_ ? std::max(last_ns_, message.log_ns) : message.log_ns;
  any_in_chunk_ = true;
  start_ns_ = messages_ == 0 ? message.log_ns : std::min(start_ns_, message.log_ns);
  end_ns_ = messages_ == 0 ? message.log_ns : std::max(end_ns_, message.log_ns);
  ++messages_;
  ++counts_[message.channel];
  if (chunk_.size() >= kChunk_bytes) end_chunk();
}

void McapWriter::end_chunk() {
  if (!any_in_chunk_) return;
  ChunkFacts facts{first_ns_, last_ns_, 0, 0, 0, 0, chunk_.size(), {}, true};
  std::string packed = level_ > 0 ? compressed(chunk_, level_) : chunk_;
  // Data that does not shrink (pictures that are compressed already) stays as it is.
  facts.packed = packed.size() < chunk_.size();
  if (!facts.packed) packed = chunk_;
  facts.compressed = packed.size();
  std::string content;
  put(content, facts.first_ns);
  put(content, facts.last_ns);
  put(content, facts.uncompressed);
  put(content, crc_of(chunk_));
  put_text(content, facts.packed ? "zstd" : "");
  put(content, facts.compressed);
  content += packed;
  facts.offset = written_;
  record(McapOp::kChunk, content);
  facts.length = written_ - facts.offset;

  const std::uint64_t index_from = written_;
  for (const auto& [channel, places] : places_) {
    std::string index;
    put(index, channel);
    put(index, static_cast<std::uint32_t>(16 * places.size()));
    for (const auto& [time_ns, at] : places) put(index, time_ns), put(index, at);
    facts.index_offsets[channel] = written_;
    record(McapOp::kMessageIndex, index);
  }
  facts.index_length = written_ - index_from;
  chunks_.push_back(std::move(facts));
  since_told_bytes_ += chunk_.size();
  if (since_told_bytes_ >= kChunk_bytes) {
    since_told_bytes_ = 0;
    std::fill(schema_told_.begin(), schema_told_.end(), false);
    std::fill(channel_told_.begin(), channel_told_.end(), false);
  }
  chunk_.clear();
  places_.clear();
  any_in_chunk_ = false;
}

void McapWriter::attachment(const McapAttachment& attachment) {
  std::string content;
  put(content, attachment.log_ns);
  put(content, attachment.create_ns);
  put_text(content, attachment.name);
  put_text(content, attachment.media_type);
  put(content, static_cast<std::uint64_t>(attachment.data.size()));
  put_bytes(content, attachment.data);
  put(content, crc_of(content));
  const std::uint64_t from = written_;
  record(McapOp::kAttachment, content);
  std::string index;
  put(index, from);
  put(index, written_ - from);
  put(index, attachment.log_ns);
  put(index, attachment.create_ns);
  put(index, static_cast<std::uint64_t>(attachment.data.size()));
  put_text(index, attachment.name);
  put_text(index, attachment.media_type);
  side_indexes_.emplace_back(McapOp::kAttachmentIndex, std::move(index));
  ++attachments_;
}

void McapWriter::metadata(const McapMetadata& metadata) {
  std::string content;
  put_text(content, metadata.name);
  put_words(content, metadata.words);
  const std::uint64_t from = written_;
  record(McapOp::kMetadata, content);
  std::string index;
  put(index, from);
  put(index, written_ - from);
  put_text(index, metadata.name);
  side_indexes_.emplace_back(McapOp::kMetadataIndex, std::move(index));
  ++metadatas_;
}

void McapWriter::finish() {
  end_chunk();
  std::string end;
  put(end, data_crc_);
  record(McapOp::kDataEnd, end);

  // Groups of like records, and where each group lies.
  const std::uint64_t summary_start = written_;
  std::string summary, offsets;
  const auto group = [&](McapOp op, const auto& add) {
    const std::uint64_t from = summary_start + summary.size();
    add();
    const std::uint64_t length = summary_start + summary.size() - from;
    if (length == 0) return;
    std::string offset;
    put(offset, static_cast<std::uint8_t>(op));
    put(offset, from);
    put(offset, length);
    put_record(offsets, McapOp::kSummaryOffset, offset);
  };
  group(McapOp::kSchema, [&] {
    for (std::size_t i = 0; i < schemas_.size(); ++i)
      if (schema_in_file_[i])
        put_record(summary, McapOp::kSchema, schema_content(i + 1, schemas_[i]));
  });
  group(McapOp::kChannel, [&] {
    for (std::size_t i = 0; i < channels_.size(); ++i)
      if (channel_in_file_[i])
        put_record(summary, McapOp::kChannel, channel_content(i, channels_[i]));
  });
  group(McapOp::kStatistics, [&] {
    std::string content, counts;
    put(content, messages_);
    put(content, static_cast<std::uint16_t>(std::ranges::count(schema_in_file_, true)));
    put(content, static_cast<std::uint32_t>(std::ranges::count(channel_in_file_, true)));
    put(content, attachments_);
    put(content, metadatas_);
    put(content, static_cast<std::uint32_t>(chunks_.size()));
    put(content, start_ns_);
    put(content, end_ns_);
    for (std::size_t i = 0; i < counts_.size(); ++i)
      if (counts_[i] > 0) put(counts, static_cast<std::uint16_t>(i)), put(counts, counts_[i]);
    put_text(content, counts);
    put_record(summary, McapOp::kStatistics, content);
  });
  group(McapOp::kChunkIndex, [&] {
    for (const ChunkFacts& chunk : chunks_) {
      std::string content, places;
      put(content, chunk.first_ns);
      put(content, chunk.last_ns);
      put(content, chunk.offset);
      put(content, chunk.length);
      for (const auto& [channel, at] : chunk.index_offsets) put(places, channel), put(places, at);
      put_text(content, places);
      put(content, chunk.index_length);
      put_text(content, chunk.packed ? "zstd" : "");
      put(content, chunk.compressed);
      put(content, chunk.uncompressed);
      put_record(summary, McapOp::kChunkIndex, content);
    }
  });
  for (const McapOp op : {McapOp::kAttachmentIndex, McapOp::kMetadataIndex})
    group(op, [&] {
      for (const auto& [kind, content] : side_indexes_)
        if (kind == op) put_record(summary, op, content);
    });

  const std::uint64_t offsets_start = summary_start + summary.size();
  summary += offsets;
  // The CRC covers the summary and the footer up to itself.
  put(summary, static_cast<std::uint8_t>(McapOp::kFooter));
  put(summary, std::uint64_t{20});
  put(summary, summary_start);
  put(summary, offsets_start);
  put(summary, crc_of(summary));
  out_ += summary;
  out_ += kMcapMagic;
}

}  // namespace neritic::recording
