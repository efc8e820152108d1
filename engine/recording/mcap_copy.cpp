#include "engine/recording/mcap_copy.hpp"

#include "engine/core/growing_file.hpp"
#include "engine/core/version.hpp"
#include "engine/recording/mcap_writer.hpp"

namespace neritic::recording {
namespace {

// Hands the bytes on as they are made, so that the memory stays bounded.
class Draining final : public McapOut {
 public:
  Draining(McapWriter& writer, GrowingFile& file) : writer_(writer), file_(file) {}
  std::uint16_t add_schema(McapSchema schema) override {
    return writer_.add_schema(std::move(schema));
  }
  std::uint16_t add_channel(McapChannel channel) override {
    return writer_.add_channel(std::move(channel));
  }
  // No file is begun before there is a message for it.
  void message(const McapMessage& message) override {
    writer_.message(message);
    begun_ = true;
    drain();
  }
  void attachment(const McapAttachment& attachment) override {
    writer_.attachment(attachment);
    if (begun_) drain();
  }
  void metadata(const McapMetadata& metadata) override { writer_.metadata(metadata); }
  void drain() {
    if (status_.ok()) status_ = file_.append(writer_.take());
  }
  const Status& status() const { return status_; }

 private:
  McapWriter& writer_;
  GrowingFile& file_;
  Status status_;
  bool begun_ = false;
};

}  // namespace

Status McapCopy::schema(std::uint16_t id, const McapSchema& schema) {
  schemas_[id] = out_.add_schema(schema);
  return {};
}

Status McapCopy::channel(std::uint16_t id, const McapChannel& channel) {
  McapChannel copy = channel;
  if (channel.schema != 0) copy.schema = schemas_.at(channel.schema);
  channels_[id] = out_.add_channel(std::move(copy));
  return {};
}

Status McapCopy::message(const McapMessage& message) {
  McapMessage copy = message;
  copy.channel = channels_.at(message.channel);
  out_.message(copy);
  return {};
}

Status McapCopy::attachment(const McapAttachment& attachment) {
  out_.attachment(attachment);
  return {};
}

Status McapCopy::metadata(const McapMetadata& metadata) {
  out_.metadata(metadata);
  return {};
}

Result<McapReport> repair_mcap(const std::filesystem::path& from, const std::filesystem::path& to) {
  NERITIC_TRY(const auto source, open_mcap(from));
  McapWriter writer("ros2", program_version());
  GrowingFile file(to);
  Draining out(writer, file);
  McapCopy copy(out);
  NERITIC_TRY(const McapReport report, read_mcap(*source, from.string(), copy, AfterDamage::kGoOn));
  if (report.messages == 0 && !report.whole)
    return failure(ErrorCode::kUnsupported, "{}: nothing of it can be rescued{}", from.string(),
                   report.damage.empty() ? "" : ": " + report.damage.front());
  writer.finish();
  out.drain();
  NERITIC_TRY_STATUS(out.status());
  NERITIC_TRY_STATUS(file.finish());
  return report;
}

}  // namespace neritic::recording
