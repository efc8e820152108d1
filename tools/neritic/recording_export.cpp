#include "tools/neritic/recording_export.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "engine/core/files.hpp"
#include "engine/core/growing_file.hpp"
#include "engine/core/json.hpp"
#include "engine/core/log.hpp"
#include "engine/core/npy.hpp"
#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"
#include "engine/recording/mcap_reader.hpp"
#include "engine/recording/ros_message.hpp"
#include "engine/recording/xdf_writer.hpp"
#include "tools/common/outputs.hpp"
#include "tools/neritic/recording_pictures.hpp"

namespace neritic::tools {
namespace {

namespace fs = std::filesystem;
using recording::McapMessage;
using recording::RosMessage;
using recording::RosValue;

// "/rov/imu" as "rov_imu", so that no topic leaves the folder.
std::string file_name(const std::string& topic) {
  std::string name;
  for (const char c : topic)
    name += (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ? c : '_';
  while (name.starts_with('_')) name.erase(0, 1);
  return name.empty() ? "topic" : name.substr(0, 200);
}

std::string in_cell(const RosValue& value) {
  if (const auto* number = std::get_if<double>(&value))
    return std::isnan(*number) ? "" : fmt::format("{}", *number);
  if (const auto* number = std::get_if<std::int64_t>(&value)) return fmt::format("{}", *number);
  if (const auto* number = std::get_if<std::uint64_t>(&value)) return fmt::format("{}", *number);
  if (const auto* text = std::get_if<std::string>(&value)) {
    std::string out = printable(*text, 1000);
    if (out.find_first_of(",\"") == out.npos) return out;
    std::string quoted = "\"";
    for (const char c : out) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + "\"";
  }
  return fmt::format("{}", fmt::join(std::get<std::vector<double>>(value), " "));
}

// The form that one topic is exported to.
class TopicFile {
 public:
  virtual ~TopicFile() = default;
  virtual Status add(const McapMessage& message) = 0;
  virtual Status finish() = 0;
};

// The columns that a table of numbers has.
std::vector<std::size_t> number_columns(const RosMessage& type) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < type.columns().size(); ++i)
    if (!type.columns()[i].list && !type.columns()[i].text) out.push_back(i);
  return out;
}

Error not_whole(const std::string& topic) {
  return bad_input("{}: a message that does not fit its schema", printable(topic));
}

// Lists of more than 64 numbers (pictures) are left out: they have forms of their own.
class CsvTopic final : public TopicFile {
 public:
  CsvTopic(const fs::path& path, std::string topic, RosMessage type)
      : topic_(std::move(topic)), type_(std::move(type)), file_(path) {
    std::vector<std::string> names{"time_s"};
    for (const auto& column : type_.columns()) names.push_back(column.name);
    head_ = fmt::format("{}\n", fmt::join(names, ","));
  }
  Status add(const McapMessage& message) override {
    const auto values = type_.read(message.data);
    if (!values) return not_whole(topic_);
    std::string row = std::exchange(head_, {});
    row += fmt::format("{}", static_cast<double>(message.log_ns) * 1e-9);
    for (const RosValue& value : *values) {
      const auto* list = std::get_if<std::vector<double>>(&value);
      row += ",";
      if (!list || list->size() <= 64) row += in_cell(value);
    }
    return file_.append(row + "\n");
  }
  Status finish() override {
    NERITIC_TRY_STATUS(file_.append(head_));
    return file_.finish();
  }

 private:
  std::string topic_, head_;
  RosMessage type_;
  GrowingFile file_;
};

// A row a message, a column a number, beside them the columns' names.
class NpyTopic final : public TopicFile {
 public:
  NpyTopic(fs::path path, std::string topic, RosMessage type)
      : path_(std::move(path)),
        topic_(std::move(topic)),
        type_(std::move(type)),
        columns_(number_columns(type_)) {}
  Status add(const McapMessage& message) override {
    const auto values = type_.read(message.data);
    if (!values) return not_whole(topic_);
    rows_.push_back(static_cast<double>(message.log_ns) * 1e-9);
    for (const std::size_t i : columns_) rows_.push_back(recording::number_of((*values)[i]));
    return {};
  }
  Status finish() override {
    const std::size_t width = columns_.size() + 1;
    NERITIC_TRY_STATUS(write_npy(path_, rows_, {rows_.size() / width, width}));
    nlohmann::json names{"time_s"};
    for (const std::size_t i : columns_) names.push_back(type_.columns()[i].name);
    return write_text(path_.replace_extension(".json"),
                      json_text({{"topic", topic_}, {"columns", names}}) + "\n");
  }

 private:
  fs::path path_;
  std::string topic_;
  RosMessage type_;
  std::vector<std::size_t> columns_;
  std::vector<double> rows_;
};

// A signal that comes in packets of samples, as a microphone's sound.
struct Packet {
  double begun_s = 0.0, rate_hz = 1.0;  // of its first sample
  std::vector<double> samples;
  double time_s(std::size_t i) const { return begun_s + static_cast<double>(i) / rate_hz; }
};
class Signal {
 public:
  // Nothing: the messages of that type have no packets.
  static std::optional<Signal> of(const std::string& topic, const RosMessage& type) {
    const auto samples = type.column("samples"), rate = type.column("rate_hz");
    if (!samples || !rate || !type.columns()[*samples].list) return std::nullopt;
    return Signal(topic, type, *samples, *rate);
  }
  // When it was captured counts, not when it came.
  Result<Packet> read(const McapMessage& message) const {
    auto values = type_.read(message.data);
    if (!values) return not_whole(topic_);
    return Packet{static_cast<double>(message.publish_ns) * 1e-9,
                  std::clamp(recording::number_of((*values)[rate_]), 1.0, 1e6),
                  std::move(std::get<std::vector<double>>((*values)[samples_]))};
  }
  const std::string& topic() const { return topic_; }

 private:
  Signal(std::string topic, RosMessage type, std::size_t samples, std::size_t rate)
      : topic_(std::move(topic)), type_(std::move(type)), samples_(samples), rate_(rate) {}
  std::string topic_;
  RosMessage type_;
  std::size_t samples_, rate_;
};

// As 32-bit floats at one rate; silence where packets were lost.
class WavTopic final : public TopicFile {
 public:
  WavTopic(fs::path path, Signal signal) : path_(std::move(path)), signal_(std::move(signal)) {}
  Status add(const McapMessage& message) override {
    NERITIC_TRY(const Packet packet, signal_.read(message));
    if (sound_.empty()) begun_s_ = packet.begun_s, rate_hz_ = packet.rate_hz;
    // Clocks are known to milliseconds: less than half a packet is no gap.
    const double lacks =
        (packet.begun_s - begun_s_) * rate_hz_ - static_cast<double>(sound_.size());
    if (lacks > 0.5 * static_cast<double>(packet.samples.size())) {
      if (lacks > kMostSilence_s * rate_hz_)
        return bad_input("{}: a gap of {:.0f} s; accepted: up to {:.0f} s in a .wav",
                         printable(signal_.topic()), lacks / rate_hz_, kMostSilence_s);
      sound_.resize(sound_.size() + static_cast<std::size_t>(std::llround(lacks)), 0.0f);
      ++gaps_;
      silence_s_ += lacks / rate_hz_;
    }
    for (const double x : packet.samples) sound_.push_back(static_cast<float>(x));
    return {};
  }
  Status finish() override {
    if (gaps_ > 0)
      log_warn("{}: {} gap{} of lost packets, {:.3g} s in all, {} silence",
               printable(signal_.topic()), gaps_, gaps_ == 1 ? "" : "s", silence_s_,
               gaps_ == 1 ? "is" : "are");
    const auto rate = static_cast<std::uint32_t>(std::lround(rate_hz_));
    const auto bytes = static_cast<std::uint32_t>(sound_.size() * sizeof(float));
    std::string out = "RIFF";
    const auto put = [&](auto value) {
      out.append(reinterpret_cast<const char*>(&value), sizeof value);
    };
    put(std::uint32_t{36 + bytes});
    out += "WAVEfmt ";
    put(std::uint32_t{16}), put(std::uint16_t{3}), put(std::uint16_t{1});  // floats, one channel
    put(rate), put(rate * 4), put(std::uint16_t{4}), put(std::uint16_t{32});
    out += "data";
    put(bytes);
    out.append(reinterpret_cast<const char*>(sound_.data()), bytes);
    return write_text(path_, out);
  }

 private:
  static constexpr double kMostSilence_s = 3600.0;
  fs::path path_;
  Signal signal_;
  double begun_s_ = 0.0, rate_hz_ = 1.0, silence_s_ = 0.0;
  std::uint64_t gaps_ = 0;
  std::vector<float> sound_;
};

// A row a sample, with the time when it was captured.
class SignalCsv final : public TopicFile {
 public:
  SignalCsv(const fs::path& path, Signal signal) : signal_(std::move(signal)), file_(path) {}
  Status add(const McapMessage& message) override {
    NERITIC_TRY(const Packet packet, signal_.read(message));
    std::string rows = std::exchange(head_, {});
    for (std::size_t i = 0; i < packet.samples.size(); ++i)
      rows += fmt::format("{:.9f},{}\n", packet.time_s(i), static_cast<float>(packet.samples[i]));
    return file_.append(rows);
  }
  Status finish() override {
    NERITIC_TRY_STATUS(file_.append(head_));
    return file_.finish();
  }

 private:
  Signal signal_;
  std::string head_ = "captured_s,sample\n";
  GrowingFile file_;
};

class SignalNpy final : public TopicFile {
 public:
  SignalNpy(fs::path path, Signal signal) : path_(std::move(path)), signal_(std::move(signal)) {}
  Status add(const McapMessage& message) override {
    NERITIC_TRY(const Packet packet, signal_.read(message));
    for (std::size_t i = 0; i < packet.samples.size(); ++i) {
      rows_.push_back(packet.time_s(i));
      rows_.push_back(packet.samples[i]);
    }
    return {};
  }
  Status finish() override {
    NERITIC_TRY_STATUS(write_npy(path_, rows_, {rows_.size() / 2, 2}));
    return write_text(
        path_.replace_extension(".json"),
        json_text({{"topic", signal_.topic()}, {"columns", {"captured_s", "sample"}}}) + "\n");
  }

 private:
  fs::path path_;
  Signal signal_;
  std::vector<double> rows_;
};

// A picture a message: of a camera or a sonar.
class PngTopic final : public TopicFile {
 public:
  PngTopic(fs::path folder, std::string topic, std::string type_name, RosMessage type)
      : folder_(std::move(folder)),
        topic_(std::move(topic)),
        type_name_(std::move(type_name)),
        type_(std::move(type)) {}
  Status add(const McapMessage& message) override {
    NERITIC_TRY_STATUS(make_folder(folder_));
    const fs::path path = folder_ / fmt::format("{:06}_{:.3f}s.png", count_++,
                                                static_cast<double>(message.log_ns) * 1e-9);
    return write_message_picture(path, topic_, type_name_, type_, message.data);
  }
  Status finish() override { return {}; }

 private:
  fs::path folder_;
  std::string topic_, type_name_;
  RosMessage type_;
  std::uint64_t count_ = 0;
};

// All topics with numbers in one file.
struct Xdf {
  recording::XdfWriter writer;
  GrowingFile file;
};
class XdfTopic final : public TopicFile {
 public:
  XdfTopic(Xdf& xdf, std::string topic, RosMessage type)
      : xdf_(xdf),
        topic_(std::move(topic)),
        type_(std::move(type)),
        columns_(number_columns(type_)) {
    recording::XdfStream stream{topic_, topic_.substr(topic_.rfind('/') + 1), {}, 0.0};
    for (const std::size_t i : columns_) stream.channels.push_back(type_.columns()[i].name);
    id_ = xdf_.writer.add_stream(stream);
  }
  Status add(const McapMessage& message) override {
    const auto values = type_.read(message.data);
    if (!values) return not_whole(topic_);
    std::vector<double> row;
    for (const std::size_t i : columns_) row.push_back(recording::number_of((*values)[i]));
    // When it was captured, as the times of XDF are.
    xdf_.writer.sample(id_, static_cast<double>(message.publish_ns) * 1e-9, row);
    return xdf_.file.append(xdf_.writer.take());
  }
  Status finish() override { return {}; }

 private:
  Xdf& xdf_;
  std::string topic_;
  RosMessage type_;
  std::vector<std::size_t> columns_;
  std::uint32_t id_ = 0;
};

// A sample at its time; the stream has the rate of the first packet.
class XdfSignal final : public TopicFile {
 public:
  XdfSignal(Xdf& xdf, Signal signal) : xdf_(xdf), signal_(std::move(signal)) {}
  Status add(const McapMessage& message) override {
    NERITIC_TRY(const Packet packet, signal_.read(message));
    const std::string& topic = signal_.topic();
    if (!id_)
      id_ = xdf_.writer.add_stream(
          {topic, topic.substr(topic.rfind('/') + 1), {"sample"}, packet.rate_hz});
    for (std::size_t i = 0; i < packet.samples.size(); ++i)
      xdf_.writer.sample(*id_, packet.time_s(i), {&packet.samples[i], 1});
    return xdf_.file.append(xdf_.writer.take());
  }
  Status finish() override { return {}; }

 private:
  Xdf& xdf_;
  Signal signal_;
  std::optional<std::uint32_t> id_;
};

class ExportVisitor final : public recording::McapVisitor {
 public:
  ExportVisitor(const RecordingFlags& flags, const fs::path& xdf) : flags_(flags) {
    if (flags.format == "xdf") xdf_.emplace(recording::XdfWriter(), GrowingFile(xdf));
  }

  Status schema(std::uint16_t id, const recording::McapSchema& schema) override {
    schemas_[id] = schema;
    return {};
  }
  Status channel(std::uint16_t id, const recording::McapChannel& channel) override {
    seen_.insert(channel.topic);
    if (!flags_.topics.empty() &&
        std::ranges::find(flags_.topics, channel.topic) == flags_.topics.end())
      return {};
    const recording::McapSchema& schema = schemas_[channel.schema];
    auto type = RosMessage::parse(schema);
    if (!type.ok()) {
      log_warn("{}: left out: {}", printable(channel.topic), type.error().message);
      return {};
    }
    std::string name = file_name(channel.topic);
    while (!names_.insert(name).second) name += "_2";
    files_[id] = file_of(channel.topic, name, schema, std::move(*type));
    return {};
  }
  Status message(const McapMessage& message) override {
    const auto at = files_.find(message.channel);
    if (at == files_.end() || !at->second) return {};
    ++messages_;
    return at->second->add(message);
  }
  // The topics that were asked for and are not there.
  Status finish() {
    for (const std::string& topic : flags_.topics)
      if (!seen_.contains(topic))
        return refusal("--topic", printable(topic), fmt::format("{}", fmt::join(seen_, ", ")));
    for (const auto& [id, file] : files_)
      if (file) NERITIC_TRY_STATUS(file->finish());
    if (!xdf_) return {};
    xdf_->writer.finish();
    NERITIC_TRY_STATUS(xdf_->file.append(xdf_->writer.take()));
    return xdf_->file.finish();
  }
  std::size_t topics() const {
    return static_cast<std::size_t>(
        std::ranges::count_if(files_, [](const auto& file) { return file.second != nullptr; }));
  }
  std::uint64_t messages() const { return messages_; }

 private:
  std::unique_ptr<TopicFile> file_of(const std::string& topic, const std::string& name,
                                     const recording::McapSchema& schema, RosMessage type) {
    const fs::path path = flags_.out / (name + "." + flags_.format);
    if (auto signal = Signal::of(topic, type)) {
      if (flags_.format == "csv") return std::make_unique<SignalCsv>(path, std::move(*signal));
      if (flags_.format == "npy") return std::make_unique<SignalNpy>(path, std::move(*signal));
      if (flags_.format == "xdf") return std::make_unique<XdfSignal>(*xdf_, std::move(*signal));
      if (flags_.format == "wav" && schema.name == "neritic_msgs/msg/Audio")
        return std::make_unique<WavTopic>(path, std::move(*signal));
    }
    if (flags_.format == "csv") return std::make_unique<CsvTopic>(path, topic, std::move(type));
    if (flags_.format == "npy") return std::make_unique<NpyTopic>(path, topic, std::move(type));
    if (flags_.format == "xdf") {
      if (number_columns(type).empty()) return nullptr;
      return std::make_unique<XdfTopic>(*xdf_, topic, std::move(type));
    }
    if (!is_picture(schema.name)) return nullptr;
    return std::make_unique<PngTopic>(flags_.out / name, topic, schema.name, std::move(type));
  }

  const RecordingFlags& flags_;
  std::optional<Xdf> xdf_;
  std::map<std::uint16_t, recording::McapSchema> schemas_;
  std::map<std::uint16_t, std::unique_ptr<TopicFile>> files_;
  std::set<std::string> names_, seen_;
  std::uint64_t messages_ = 0;
};

}  // namespace

Status write_xdf(const fs::path& mcap, const fs::path& xdf) {
  RecordingFlags flags;
  flags.format = "xdf";
  NERITIC_TRY(const auto source, recording::open_mcap(mcap));
  ExportVisitor visitor(flags, xdf);
  const auto report =
      recording::read_mcap(*source, mcap.string(), visitor, recording::AfterDamage::kGoOn);
  if (!report.ok()) return report.error();
  return visitor.finish();
}

Result<std::string> export_recording(const RecordingFlags& flags) {
  if (flags.out.empty()) return refusal("--out", "none", "a folder");
  NERITIC_TRY_STATUS(check_output_folder("--out", flags.out.string()));
  NERITIC_TRY(const auto source, recording::open_mcap(flags.file));
  NERITIC_TRY_STATUS(make_folder(flags.out));
  ExportVisitor visitor(flags, flags.out / "recording.xdf");
  NERITIC_TRY(const auto report,
              recording::read_mcap(*source, flags.file, visitor, recording::AfterDamage::kGoOn));
  NERITIC_TRY_STATUS(visitor.finish());
  if (!report.whole)
    log_warn("{}: {}; the readable part is exported", flags.file,
             report.damages > 0 ? report.damage.front() : "cut off: it has no end");
  if (visitor.topics() == 0)
    return refusal(flags.file, fmt::format("no topic that can be a .{}", flags.format),
                   flags.format == "wav"   ? "a topic with samples and rate_hz"
                   : flags.format == "png" ? "a topic of pictures (dive --record-images)"
                                           : "a topic with numbers");
  return fmt::format("{}: {} topics, {} messages as .{}", flags.out.string(), visitor.topics(),
                     visitor.messages(), flags.format);
}

}  // namespace neritic::tools
