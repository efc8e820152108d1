#include "engine/recording/mcap_reader.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"
#include "engine/recording/mcap_bytes.hpp"
#include "engine/recording/mcap_chunk.hpp"

namespace neritic::recording {
namespace {

constexpr std::size_t kNamedDamages = 20;

class Reading {
 public:
  Reading(McapSource& source, const std::string& name, McapVisitor& visitor, AfterDamage after)
      : source_(source), name_(name), visitor_(visitor), after_(after) {}

  Result<McapReport> run();

 private:
  // The findings of one step of the reading.
  enum class Next { kGoOn, kEnd };

  Result<Next> record();
  bool sound(Head head, std::uint64_t at) const;
  Result<bool> sound_at(std::uint64_t at);
  Result<Next> past(Head head, std::uint64_t from);
  Status content(Head head, std::uint64_t at);
  Status chunk(std::span<const std::byte> content, std::uint64_t at);
  Status chunk_records(std::span<const std::byte> records, std::uint64_t at);
  Status schema(McapCursor cursor, std::uint64_t at);
  Status channel(McapCursor cursor, std::uint64_t at);
  Status message(McapCursor cursor, std::uint64_t at);
  Status recall_schema(std::uint16_t id);
  Status recall_channel(std::uint16_t id);
  void read_summary();
  void tell_unknown();
  Status attachment(std::span<const std::byte> content, std::uint64_t at);
  Status metadata(McapCursor cursor, std::uint64_t at);
  void summary_record(Head head, McapCursor cursor, std::uint64_t at);
  void footer(std::span<const std::byte> content, std::uint64_t at);
  // Something that is not as it should be.
  void damaged(std::uint64_t at, const std::string& what) {
    if (++report_.damages <= kNamedDamages)
      report_.damage.push_back(fmt::format("at byte {}: {}", at, what));
  }
  bool stopped() const { return report_.damages > 0 && after_ == AfterDamage::kStop; }

  McapSource& source_;
  const std::string& name_;
  McapVisitor& visitor_;
  AfterDamage after_;
  McapReport report_;
  std::uint64_t at_ = 0;
  std::vector<std::byte> content_, unpacked_;
  std::set<std::uint16_t> schemas_, channels_;
  // From the summary, for channels whose records in the data section are damaged.
  std::map<std::uint16_t, McapSchema> summary_schemas_;
  std::map<std::uint16_t, McapChannel> summary_channels_;
  bool summary_read_ = false;
  std::uint64_t unknown_ = 0, unknown_at_ = 0;  // messages of channels that are nowhere
  std::set<std::uint16_t> unknown_channels_;
  std::set<std::pair<std::uint64_t, std::uint64_t>> chunks_;  // place and length
  std::uint32_t data_crc_ = 0, summary_crc_ = 0;
  bool in_summary_ = false, ended_ = false;
};

McapSchema schema_of(McapCursor& cursor) {
  return {cursor.text(), cursor.text(), cursor.text()};
}
McapChannel channel_of(McapCursor& cursor) {
  McapChannel channel{cursor.number<std::uint16_t>(), cursor.text(), cursor.text(), {}};
  channel.metadata = cursor.words();
  return channel;
}

// The schemas and channels of a summary whose CRC is right.
void Reading::read_summary() {
  if (std::exchange(summary_read_, true)) return;
  constexpr std::size_t kFooter = kRecordHead_bytes + 20;
  const std::uint64_t size = source_.size(), end_bytes = kFooter + kMcapMagic.size();
  if (size < end_bytes + kMcapMagic.size()) return;
  std::vector<std::byte> end(end_bytes);
  if (!source_.read(size - end_bytes, end).ok()) return;
  McapCursor footer(end);
  const auto op = static_cast<McapOp>(footer.number<std::uint8_t>());
  const auto length = footer.number<std::uint64_t>(), start = footer.number<std::uint64_t>();
  footer.take(8);
  const auto crc = footer.number<std::uint32_t>();
  if (op != McapOp::kFooter || length != 20 || crc == 0 || start < kMcapMagic.size() ||
      start > size - end_bytes || size - end_bytes - start > kMostRecord_bytes)
    return;
  std::vector<std::byte> summary(static_cast<std::size_t>(size - end_bytes - start));
  if (!source_.read(start, summary).ok()) return;
  if (crc_of(std::span(end).first(kFooter - sizeof crc), crc_of(summary)) != crc) return;
  McapCursor cursor(summary);
  while (cursor.left() > 0) {
    const auto kind = static_cast<McapOp>(cursor.number<std::uint8_t>());
    McapCursor content(cursor.take(cursor.number<std::uint64_t>()));
    if (!cursor.whole()) return;
    if (kind != McapOp::kSchema && kind != McapOp::kChannel) continue;
    const auto id = content.number<std::uint16_t>();
    if (kind == McapOp::kSchema) {
      McapSchema schema = schema_of(content);
      if (content.whole() && id != 0) summary_schemas_.emplace(id, std::move(schema));
    } else {
      McapChannel channel = channel_of(content);
      if (content.whole()) summary_channels_.emplace(id, std::move(channel));
    }
  }
}

// Gives the visitor what the data section lacks and the summary has.
Status Reading::recall_schema(std::uint16_t id) {
  if (after_ == AfterDamage::kStop) return {};
  read_summary();
  const auto at = summary_schemas_.find(id);
  if (at == summary_schemas_.end() || !schemas_.insert(id).second) return {};
  return visitor_.schema(id, at->second);
}

Status Reading::recall_channel(std::uint16_t id) {
  if (after_ == AfterDamage::kStop) return {};
  read_summary();
  const auto at = summary_channels_.find(id);
  if (at == summary_channels_.end()) return {};
  const std::uint16_t schema = at->second.schema;
  if (schema != 0 && !schemas_.contains(schema)) NERITIC_TRY_STATUS(recall_schema(schema));
  if ((schema != 0 && !schemas_.contains(schema)) || !channels_.insert(id).second) return {};
  return visitor_.channel(id, at->second);
}

Status Reading::schema(McapCursor cursor, std::uint64_t at) {
  const auto id = cursor.number<std::uint16_t>();
  const McapSchema schema = schema_of(cursor);
  if (!cursor.whole() || id == 0) return damaged(at, "a schema that is cut off"), Status();
  if (!schemas_.insert(id).second) return {};
  return visitor_.schema(id, schema);
}

Status Reading::channel(McapCursor cursor, std::uint64_t at) {
  const auto id = cursor.number<std::uint16_t>();
  const McapChannel channel = channel_of(cursor);
  if (!cursor.whole()) return damaged(at, "a channel that is cut off"), Status();
  if (channel.schema != 0 && !schemas_.contains(channel.schema))
    NERITIC_TRY_STATUS(recall_schema(channel.schema));
  if (channel.schema != 0 && !schemas_.contains(channel.schema))
    return damaged(at, fmt::format("channel {} of schema {}, which comes nowhere before", id,
                                   channel.schema)),
           Status();
  if (!channels_.insert(id).second) return {};
  return visitor_.channel(id, channel);
}

Status Reading::message(McapCursor cursor, std::uint64_t at) {
  McapMessage message{cursor.number<std::uint16_t>(),
                      cursor.number<std::uint32_t>(),
                      cursor.number<std::uint64_t>(),
                      cursor.number<std::uint64_t>(),
                      {}};
  if (!cursor.whole()) return damaged(at, "a message that is cut off"), Status();
  message.data = cursor.rest();
  if (!channels_.contains(message.channel)) NERITIC_TRY_STATUS(recall_channel(message.channel));
  if (!channels_.contains(message.channel)) {
    if (unknown_++ == 0) unknown_at_ = at;
    unknown_channels_.insert(message.channel);
    if (after_ == AfterDamage::kStop) tell_unknown();
    return {};
  }
  const bool first = report_.messages++ == 0;
  report_.first_ns = first ? message.log_ns : std::min(report_.first_ns, message.log_ns);
  report_.last_ns = first ? message.log_ns : std::max(report_.last_ns, message.log_ns);
  return visitor_.message(message);
}

// One damage for all such messages of the file.
void Reading::tell_unknown() {
  if (unknown_ == 0) return;
  const std::size_t channels = unknown_channels_.size();
  if (unknown_ == 1)
    damaged(unknown_at_, fmt::format("a message of channel {}, which comes nowhere before",
                                     *unknown_channels_.begin()));
  else
    damaged(unknown_at_,
            fmt::format("{} messages of {}, which come{} nowhere before", unknown_,
                        channels == 1 ? fmt::format("channel {}", *unknown_channels_.begin())
                                      : fmt::format("{} channels", channels),
                        channels == 1 ? "s" : ""));
  unknown_ = 0;
}

Status Reading::chunk(std::span<const std::byte> content, std::uint64_t at) {
  const auto chunk = chunk_of(content);
  if (!chunk) return damaged(at, "a chunk with another size than it says"), Status();
  if (const std::string wrong = unpack(*chunk, unpacked_); !wrong.empty())
    return damaged(at, wrong), Status();
  ++report_.chunks;
  report_.unpacked_bytes += chunk->size;
  chunks_.emplace(at, kRecordHead_bytes + content.size());
  return chunk_records(unpacked_, at);
}

Status Reading::chunk_records(std::span<const std::byte> records, std::uint64_t at) {
  McapCursor cursor(records);
  while (cursor.left() > 0 && !stopped()) {
    const auto op = static_cast<McapOp>(cursor.number<std::uint8_t>());
    const McapCursor content(cursor.take(cursor.number<std::uint64_t>()));
    if (!cursor.whole()) return damaged(at, "a chunk that ends within a record"), Status();
    if (op == McapOp::kSchema) NERITIC_TRY_STATUS(schema(content, at));
    if (op == McapOp::kChannel) NERITIC_TRY_STATUS(channel(content, at));
    if (op == McapOp::kMessage) NERITIC_TRY_STATUS(message(content, at));
  }
  return {};
}

Status Reading::attachment(std::span<const std::byte> content, std::uint64_t at) {
  McapCursor cursor(content);
  McapAttachment attachment{cursor.number<std::uint64_t>(),
                            cursor.number<std::uint64_t>(),
                            cursor.text(),
                            cursor.text(),
                            {}};
  attachment.data = cursor.take(cursor.number<std::uint64_t>());
  const auto crc = cursor.number<std::uint32_t>();
  if (!cursor.whole() || cursor.left() > 0)
    return damaged(at, "an attachment that is cut off"), Status();
  if (crc != 0 && crc_of(content.first(content.size() - sizeof crc)) != crc)
    return damaged(at,
                   fmt::format("attachment '{}', whose CRC differs", printable(attachment.name))),
           Status();
  return visitor_.attachment(attachment);
}

Status Reading::metadata(McapCursor cursor, std::uint64_t at) {
  McapMetadata metadata{cursor.text(), {}};
  metadata.words = cursor.words();
  if (!cursor.whole()) return damaged(at, "metadata that are cut off"), Status();
  return visitor_.metadata(metadata);
}

// Compares the indexes with what was found.
void Reading::summary_record(Head head, McapCursor cursor, std::uint64_t at) {
  if (head.op == McapOp::kChunkIndex) {
    cursor.take(16);
    const auto offset = cursor.number<std::uint64_t>(), length = cursor.number<std::uint64_t>();
    if (!cursor.whole() || chunks_.erase({offset, length}) == 0)
      damaged(at, fmt::format("an index of a chunk at {}, where there is none", offset));
  } else if (head.op == McapOp::kStatistics) {
    const auto messages = cursor.number<std::uint64_t>();
    if (!cursor.whole() || messages != report_.messages)
      damaged(at, fmt::format("statistics of {} messages; found: {}", messages, report_.messages));
  }
}

void Reading::footer(std::span<const std::byte> content, std::uint64_t at) {
  McapCursor cursor(content);
  const auto start = cursor.number<std::uint64_t>();
  cursor.take(8);
  const auto crc = cursor.number<std::uint32_t>();
  if (!cursor.whole()) return damaged(at, "a footer that is cut off");
  if (crc != 0 && crc != summary_crc_) damaged(at, "a summary whose CRC differs");
  if (start != 0 && !chunks_.empty())
    damaged(at, fmt::format("a summary without {} of the chunks", chunks_.size()));
  std::string magic(kMcapMagic.size(), '\0');
  ended_ = source_.size() - at_ == magic.size() &&
           source_.read(at_, std::as_writable_bytes(std::span(magic))).ok() && magic == kMcapMagic;
  if (!ended_) damaged(at_, "other bytes than the end of a file");
}

// Whether such a record may stand there.
bool Reading::sound(Head head, std::uint64_t at) const {
  if (head.length > source_.size() - at - kRecordHead_bytes) return false;
  switch (head.op) {
    case McapOp::kHeader:
      return at == kMcapMagic.size();
    case McapOp::kDataEnd:
      return head.length == 4;
    case McapOp::kFooter:
      return head.length == 20 &&
             (in_summary_ ||
              at + kRecordHead_bytes + head.length + kMcapMagic.size() >= source_.size());
    case McapOp::kSchema:
    case McapOp::kChannel:
    case McapOp::kMessage:
    case McapOp::kChunk:
    case McapOp::kMessageIndex:
    case McapOp::kAttachment:
    case McapOp::kMetadata:
      return true;
    case McapOp::kChunkIndex:
    case McapOp::kAttachmentIndex:
    case McapOp::kStatistics:
    case McapOp::kMetadataIndex:
    case McapOp::kSummaryOffset:
      return in_summary_;
  }
  return static_cast<std::uint8_t>(head.op) >= 0x80;  // others' own
}

Result<bool> Reading::sound_at(std::uint64_t at) {
  if (at + kRecordHead_bytes > source_.size()) return true;  // the end, or cut off
  std::byte bytes[kRecordHead_bytes];
  NERITIC_TRY_STATUS(source_.read(at, bytes));
  return sound(head_of(bytes), at);
}

// Over a record that cannot be one: to where it says that it ends, if a sound one follows there,
// else to the next chunk.
Result<Reading::Next> Reading::past(Head head, std::uint64_t from) {
  const std::uint64_t behind = from + kRecordHead_bytes;
  const bool fits = head.length <= source_.size() - behind;
  if (fits && static_cast<std::uint8_t>(head.op) != 0) {
    NERITIC_TRY(const bool goes_on, sound_at(behind + head.length));
    if (goes_on) {
      damaged(from, "a record of a kind that cannot stand there");
      at_ = behind + head.length;
      return stopped() ? Next::kEnd : Next::kGoOn;
    }
  }
  NERITIC_TRY(const auto next, next_chunk(source_, from + 1));
  if (next) {
    damaged(from, "a record that does not end before the next chunk");
    at_ = *next;
    in_summary_ = false;
    return stopped() ? Next::kEnd : Next::kGoOn;
  }
  // A file that was cut off ends within a record.
  if (fits) damaged(from, "a record that cannot be one");
  return Next::kEnd;
}

Result<Reading::Next> Reading::record() {
  const std::uint64_t from = at_, left = source_.size() - at_;
  std::byte bytes[kRecordHead_bytes];
  if (left < kRecordHead_bytes) return Next::kEnd;
  NERITIC_TRY_STATUS(source_.read(at_, bytes));
  const Head head = head_of(bytes);
  if (!sound(head, from)) return past(head, from);
  if (head.length > kMostRecord_bytes) {
    damaged(from, fmt::format("a record of {} bytes; accepted: up to {}", head.length,
                              kMostRecord_bytes));
    return Next::kEnd;
  }
  content_.resize(static_cast<std::size_t>(head.length));
  NERITIC_TRY_STATUS(source_.read(at_ + kRecordHead_bytes, content_));
  at_ += kRecordHead_bytes + head.length;
  const std::span<const std::byte> whole(content_);
  if (head.op == McapOp::kFooter)
    summary_crc_ = crc_of(whole.first(16), crc_of(bytes, summary_crc_));
  else if (in_summary_)
    summary_crc_ = crc_of(whole, crc_of(bytes, summary_crc_));
  const std::uint64_t damages = report_.damages;
  NERITIC_TRY_STATUS(content(head, from));
  if (head.op == McapOp::kFooter) return Next::kEnd;
  if (!in_summary_) data_crc_ = crc_of(whole, crc_of(bytes, data_crc_));
  if (stopped()) return Next::kEnd;
  if (report_.damages == damages) return Next::kGoOn;
  // The length may be damaged, too.
  NERITIC_TRY(const bool goes_on, sound_at(at_));
  if (goes_on) return Next::kGoOn;
  NERITIC_TRY(const auto next, next_chunk(source_, from + 1));
  if (next) at_ = *next, in_summary_ = false;
  return Next::kGoOn;
}

// Takes what the record says.
Status Reading::content(Head head, std::uint64_t at) {
  const std::span<const std::byte> content(content_);
  switch (head.op) {
    case McapOp::kSchema:
      return schema(McapCursor(content), at);
    case McapOp::kChannel:
      return channel(McapCursor(content), at);
    case McapOp::kMessage:
      return message(McapCursor(content), at);
    case McapOp::kChunk:
      in_summary_ = false;  // what said that the data end was damaged
      return chunk(content, at);
    case McapOp::kAttachment:
      return attachment(content, at);
    case McapOp::kMetadata:
      return metadata(McapCursor(content), at);
    case McapOp::kMessageIndex: {
      McapCursor cursor(content);
      cursor.take(2);
      if (const auto bytes = cursor.number<std::uint32_t>();
          !cursor.whole() || bytes != cursor.left())
        damaged(at, "an index of messages with another size than it says");
      return {};
    }
    case McapOp::kDataEnd: {
      const auto crc = McapCursor(content).number<std::uint32_t>();
      if (crc != 0 && crc != data_crc_) damaged(at, "a data section whose CRC differs");
      in_summary_ = true;
      return {};
    }
    case McapOp::kFooter:
      footer(content, at);
      return {};
    default:
      if (in_summary_) summary_record(head, McapCursor(content), at);
      return {};
  }
}

Result<McapReport> Reading::run() {
  report_.size_bytes = source_.size();
  std::vector<std::byte> magic(kMcapMagic.size());
  const auto no_mcap = [&] {
    return refusal(name_, "no MCAP file", "a recording of this program, or another MCAP file");
  };
  if (source_.size() < magic.size()) return no_mcap();
  NERITIC_TRY_STATUS(source_.read(0, magic));
  if (std::memcmp(magic.data(), kMcapMagic.data(), magic.size()) != 0) return no_mcap();
  data_crc_ = crc_of(magic);
  at_ = magic.size();
  // The header is the first record.
  std::byte head[kRecordHead_bytes];
  if (source_.size() - at_ >= sizeof head) {
    NERITIC_TRY_STATUS(source_.read(at_, head));
    McapCursor cursor(head);
    const auto op = static_cast<McapOp>(cursor.number<std::uint8_t>());
    const auto length = cursor.number<std::uint64_t>();
    if (op != McapOp::kHeader) return no_mcap();
    if (length <= source_.size() - at_ - sizeof head && length <= kMostRecord_bytes) {
      content_.resize(static_cast<std::size_t>(length));
      NERITIC_TRY_STATUS(source_.read(at_ + sizeof head, content_));
      McapCursor words{std::span<const std::byte>(content_)};
      const std::string profile = words.text(), library = words.text();
      if (!words.whole()) return no_mcap();
      NERITIC_TRY_STATUS(visitor_.header(profile, library));
    }
  }
  while (true) {
    NERITIC_TRY(const Next next, record());
    if (next == Next::kEnd) break;
  }
  tell_unknown();
  report_.whole = ended_ && report_.damages == 0;
  return report_;
}

}  // namespace

Status McapVisitor::header(const std::string&, const std::string&) {
  return {};
}
Status McapVisitor::schema(std::uint16_t, const McapSchema&) {
  return {};
}
Status McapVisitor::channel(std::uint16_t, const McapChannel&) {
  return {};
}
Status McapVisitor::message(const McapMessage&) {
  return {};
}
Status McapVisitor::attachment(const McapAttachment&) {
  return {};
}
Status McapVisitor::metadata(const McapMetadata&) {
  return {};
}

Result<McapReport> read_mcap(McapSource& source, const std::string& name, McapVisitor& visitor,
                             AfterDamage after) {
  return Reading(source, name, visitor, after).run();
}

}  // namespace neritic::recording
