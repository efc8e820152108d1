#include "engine/recording/xdf_writer.hpp"

#include <fmt/format.h>

#include "engine/core/check.hpp"
#include "engine/recording/mcap_bytes.hpp"

namespace neritic::recording {
namespace {

constexpr std::uint16_t kFileHeader = 1, kStreamHeader = 2, kSamples = 3, kBoundary = 5,
                        kStreamFooter = 6;
constexpr std::size_t kSamplesChunk_bytes = std::size_t{1} << 16;
// By which a damaged file finds its next chunk.
constexpr unsigned char kBoundaryMark[16] = {0x43, 0xa5, 0x46, 0xdc, 0xcb, 0xf5, 0x41, 0x0f,
                                             0xb3, 0x0e, 0xd5, 0x46, 0x73, 0x83, 0xcb, 0xe4};

std::string in_xml(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c >= ' ' && c <= '~')
      out += c;
  }
  return out;
}

// The bytes that a length has, then the length.
void put_length(std::string& out, std::uint64_t length) {
  if (length < 256) {
    put(out, std::uint8_t{1}), put(out, static_cast<std::uint8_t>(length));
  } else if (length <= 0xffffffffu) {
    put(out, std::uint8_t{4}), put(out, static_cast<std::uint32_t>(length));
  } else {
    put(out, std::uint8_t{8}), put(out, length);
  }
}

}  // namespace

XdfWriter::XdfWriter() {
  out_ += "XDF:";
  chunk(kFileHeader, "<?xml version=\"1.0\"?><info><version>1.0</version></info>");
}

void XdfWriter::chunk(std::uint16_t tag, const std::string& content) {
  put_length(out_, content.size() + sizeof tag);
  put(out_, tag);
  out_ += content;
}

std::uint32_t XdfWriter::add_stream(const XdfStream& stream) {
  streams_.push_back({stream, {}, 0, 0, 0.0, 0.0});
  const auto id = static_cast<std::uint32_t>(streams_.size());
  std::string labels;
  for (const std::string& channel : stream.channels)
    labels += fmt::format("<channel><label>{}</label></channel>", in_xml(channel));
  std::string content;
  put(content, id);
  content += fmt::format(
      "<?xml version=\"1.0\"?><info><name>{}</name><type>{}</type><channel_count>{}</channel_count>"
      "<nominal_srate>{}</nominal_srate><channel_format>double64</channel_format>"
      "<desc><channels>{}</channels></desc></info>",
      in_xml(stream.name), in_xml(stream.type), stream.channels.size(), stream.rate_hz, labels);
  chunk(kStreamHeader, content);
  return id;
}

void XdfWriter::sample(std::uint32_t stream, double time_s, std::span<const double> values) {
  Open& open = streams_.at(stream - 1);
  NERITIC_CHECK(values.size() == open.stream.channels.size(), "{} values of {} channels",
                values.size(), open.stream.channels.size());
  put(open.samples, std::uint8_t{8});
  put(open.samples, time_s);
  for (const double value : values) put(open.samples, value);
  if (open.count++ == 0) open.first_s = time_s;
  open.last_s = time_s;
  ++open.waiting;
  if (open.samples.size() >= kSamplesChunk_bytes) end_chunk(stream);
}

void XdfWriter::end_chunk(std::uint32_t stream) {
  Open& open = streams_.at(stream - 1);
  if (open.waiting == 0) return;
  std::string content;
  put(content, stream);
  put_length(content, open.waiting);
  chunk(kSamples, content + open.samples);
  chunk(kBoundary, {reinterpret_cast<const char*>(kBoundaryMark), sizeof kBoundaryMark});
  open.samples.clear();
  open.waiting = 0;
}

void XdfWriter::finish() {
  for (std::uint32_t id = 1; id <= streams_.size(); ++id) {
    end_chunk(id);
    const Open& open = streams_[id - 1];
    std::string content;
    put(content, id);
    content += fmt::format(
        "<?xml version=\"1.0\"?><info><first_timestamp>{}</first_timestamp><last_timestamp>{}"
        "</last_timestamp><sample_count>{}</sample_count></info>",
        open.first_s, open.last_s, open.count);
    chunk(kStreamFooter, content);
  }
}

}  // namespace neritic::recording
