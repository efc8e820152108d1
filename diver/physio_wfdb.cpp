#include "diver/physio_wfdb.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "engine/core/refusal.hpp"

namespace neritic::diver {
namespace {

constexpr std::size_t kMostSignals = 64;
constexpr std::array kFormats{8, 16, 24, 32, 61, 80, 160, 212, 310, 311};
constexpr int kMostInAFrame = 1000;

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  while (true) {
    const auto start = line.find_first_not_of(" \t\r");
    if (start == line.npos) return words;
    line.remove_prefix(start);
    const auto end = std::min(line.find_first_of(" \t\r"), line.size());
    words.push_back(line.substr(0, end));
    line.remove_prefix(end);
  }
}

// The number that text begins with; what follows stays in text.
template <class T>
bool take_number(std::string_view& text, T& out) {
  const auto read = std::from_chars(text.data(), text.data() + text.size(), out);
  if (read.ec != std::errc()) return false;
  text.remove_prefix(static_cast<std::size_t>(read.ptr - text.data()));
  return true;
}

template <class T>
bool whole_number(std::string_view text, T& out) {
  return take_number(text, out) && text.empty();
}

// record, signals, rate, samples; what may follow (time, date) is not needed.
Result<std::size_t> record_line(const std::vector<std::string_view>& words, WfdbHeader& header,
                                const std::string& where) {
  std::size_t signals = 0;
  if (words.size() < 2 || !whole_number(words[1], signals) || signals == 0 ||
      signals > kMostSignals)
    return refusal(where, fmt::format("'{}' signals", words.size() < 2 ? "" : words[1]),
                   fmt::format("1 to {}", kMostSignals));
  if (words[0].find('/') != std::string_view::npos)
    return refusal(where, fmt::format("record '{}' of several segments", words[0]),
                   "a record of one");
  header.record = words[0];
  if (words.size() > 2) {
    std::string_view rate = words[2];
    if (!take_number(rate, header.rate_hz) || (!rate.empty() && rate[0] != '/') ||
        !(header.rate_hz >= kLeastRate_hz && header.rate_hz <= kMostRate_hz))
      return refusal(where, fmt::format("a rate of '{}'", words[2]),
                     fmt::format("{:g} to {:g} Hz", kLeastRate_hz, kMostRate_hz));
  }
  if (words.size() > 3 &&
      (!whole_number(words[3], header.samples) || header.samples > kMostSamples))
    return refusal(where, fmt::format("'{}' samples", words[3]),
                   fmt::format("at most {}", kMostSamples));
  return signals;
}

// gain(baseline)/unit
bool take_gain(std::string_view text, WfdbSignal& signal, bool& has_baseline) {
  if (!take_number(text, signal.gain)) return false;
  if (signal.gain == 0.0) signal.gain = 200.0;  // as the format defines it
  if (text.starts_with('(')) {
    text.remove_prefix(1);
    has_baseline = take_number(text, signal.baseline);
    if (!has_baseline || !text.starts_with(')')) return false;
    text.remove_prefix(1);
  }
  if (text.starts_with('/')) {
    signal.unit = text.substr(1);
    text = {};
  }
  return text.empty() && std::isfinite(signal.gain) && std::isfinite(signal.baseline);
}

// file, format+offset, gain, bits, zero, first value, checksum, block, name
Result<WfdbSignal> signal_line(const std::vector<std::string_view>& words,
                               const std::string& where) {
  if (words.size() < 2)
    return refusal(where, "fewer than two words", "file and format of a signal");
  WfdbSignal signal;
  signal.file = words[0];
  std::string_view format = words[1];
  bool known = take_number(format, signal.format) &&
               std::ranges::find(kFormats, signal.format) != kFormats.end();
  if (known && format.starts_with('x')) {
    format.remove_prefix(1);
    known = take_number(format, signal.frame_samples) && signal.frame_samples >= 1 &&
            signal.frame_samples <= kMostInAFrame;
  }
  if (known && format.starts_with('+')) {
    format.remove_prefix(1);
    known = take_number(format, signal.offset) && signal.offset >= 0;
  }
  if (!known || !format.empty())
    return refusal(
        where, fmt::format("format '{}'", words[1]),
        fmt::format("{} (perhaps x samples a frame, without skew)", fmt::join(kFormats, ", ")));
  bool has_baseline = false;
  if (words.size() > 2 && !take_gain(words[2], signal, has_baseline))
    return refusal(where, fmt::format("a gain of '{}'", words[2]),
                   "one like 200, 200(1024) or 200/mV");
  double zero = 0.0;
  if (words.size() > 4 && !whole_number(words[4], zero))
    return refusal(where, fmt::format("a zero of '{}'", words[4]), "a number");
  if (!has_baseline) signal.baseline = zero;
  if (words.size() > 5 && !whole_number(words[5], signal.first))
    return refusal(where, fmt::format("a first value of '{}'", words[5]), "a number");
  signal.has_checksum = words.size() > 6;
  if (signal.has_checksum && !whole_number(words[6], signal.checksum))
    return refusal(where, fmt::format("a checksum of '{}'", words[6]), "a number");
  if (words.size() > 8) signal.name = words[8];
  return signal;
}

// Bits of a sample, and the bytes that some samples fill together.
struct SampleLayout {
  int bits = 16;
  std::size_t bytes = 2, samples = 1;
};
SampleLayout layout_of(int format) {
  switch (format) {
    case 8:
    case 80:
      return {8, 1, 1};
    case 24:
      return {24, 3, 1};
    case 32:
      return {32, 4, 1};
    case 212:
      return {12, 3, 2};
    case 310:
    case 311:
      return {10, 4, 3};
    default:
      return {16, 2, 1};
  }
}

// Sample i of the file, as signal(5) packs it; the lowest number stands for a missing one, but in
// format 8, whose samples are differences.
std::int32_t raw_sample(std::span<const std::byte> bytes, int format, std::size_t i,
                        bool& missing) {
  const SampleLayout layout = layout_of(format);
  const std::size_t at = i / layout.samples * layout.bytes, which = i % layout.samples;
  const auto byte = [&](std::size_t k) { return std::to_integer<std::uint32_t>(bytes[at + k]); };
  const auto pair = [&](std::size_t k) { return byte(k) | byte(k + 1) << 8; };
  std::uint32_t bits = 0;
  if (format == 212)  // the second byte holds the high halves
    bits = which == 0 ? byte(0) | (byte(1) & 0x0F) << 8 : byte(2) | (byte(1) & 0xF0) << 4;
  else if (format ==
           310)  // ten bits above the lowest of each pair; the third in their highest five
    bits = which < 2 ? pair(2 * which) >> 1 & 0x3FF : pair(0) >> 11 | pair(2) >> 11 << 5;
  else if (format == 311)
    bits = which == 0 ? pair(0) & 0x3FF : (pair(0) | pair(2) << 16) >> (10 * which) & 0x3FF;
  else if (format == 61)
    bits = byte(0) << 8 | byte(1);
  else
    for (std::size_t k = 0; k < layout.bytes; ++k) bits |= byte(k) << (8 * k);
  const std::int64_t half = std::int64_t{1} << (layout.bits - 1);
  const bool offset_binary = format == 80 || format == 160;
  const std::int64_t value = offset_binary               ? std::int64_t{bits} - half
                             : std::int64_t{bits} < half ? std::int64_t{bits}
                                                         : std::int64_t{bits} - 2 * half;
  missing = format != 8 && value == -half;
  return static_cast<std::int32_t>(value);
}

std::size_t whole_samples(std::size_t bytes, int format) {
  const SampleLayout layout = layout_of(format);
  // A truncated group gives the samples whose bits are complete.
  const std::size_t rest = bytes % layout.bytes;
  const std::size_t more = layout.samples == 1 ? 0 : format == 212 ? rest / 2 : rest >= 2 ? 1 : 0;
  return bytes / layout.bytes * layout.samples + more;
}

// Codes of annot(5) beside beats.
constexpr int kSkip = 59, kNumber = 60, kSubtype = 61, kChannel = 62, kText = 63;

}  // namespace

bool is_beat(int code) {
  constexpr std::array kOther{25, 30, 34, 35, 38, 41};
  return (code >= 1 && code <= 13) || std::ranges::find(kOther, code) != kOther.end();
}
bool is_normal_beat(int code) {
  return code >= 1 && code <= 3;
}

Result<WfdbHeader> parse_wfdb_header(std::string_view text, const std::string& name) {
  WfdbHeader header;
  std::size_t expected = 0;
  int line_number = 0;
  while (!text.empty() && (expected == 0 || header.signals.size() < expected)) {
    const auto end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::string where = fmt::format("{}:{}", name, ++line_number);
    const auto words = words_of(line);
    if (words.empty() || words[0].starts_with('#')) continue;
    if (expected == 0) {
      NERITIC_TRY(expected, record_line(words, header, where));
      continue;
    }
    NERITIC_TRY(WfdbSignal signal, signal_line(words, where));
    header.signals.push_back(std::move(signal));
  }
  if (expected == 0) return refusal(name, "no record line", "one");
  if (header.signals.size() < expected)
    return refusal(name, fmt::format("{} of {} signals", header.signals.size(), expected),
                   "a line for each");
  return header;
}

Result<Recording> parse_wfdb_signal(const WfdbHeader& header, std::uint32_t channel,
                                    std::span<const std::byte> bytes, const std::string& name) {
  if (channel >= header.signals.size())
    return refusal(name, fmt::format("channel {}", channel),
                   fmt::format("0 to {}", header.signals.size() - 1));
  const WfdbSignal& signal = header.signals[channel];
  // Signals of one file lie frame by frame side by side.
  std::size_t side_by_side = 0, place = 0;
  for (std::size_t i = 0; i < header.signals.size(); ++i) {
    if (header.signals[i].file != signal.file) continue;
    if (header.signals[i].format != signal.format)
      return refusal(
          name,
          fmt::format("formats {} and {} in one file", header.signals[i].format, signal.format),
          "one");
    if (i == channel) place = side_by_side;
    side_by_side += static_cast<std::size_t>(header.signals[i].frame_samples);
  }
  bytes =
      bytes.subspan(std::min<std::size_t>(static_cast<std::size_t>(signal.offset), bytes.size()));
  const auto in_frame = static_cast<std::size_t>(signal.frame_samples);
  const std::size_t there = whole_samples(bytes.size(), signal.format) / side_by_side;
  const std::size_t count = header.samples > 0 ? header.samples : there;
  if (count == 0 || count > there || count * in_frame > kMostSamples)
    return refusal(name, fmt::format("{} samples", there),
                   fmt::format("{}", std::max<std::size_t>(count, 1)));
  Recording out{signal.name, header.rate_hz * signal.frame_samples};
  out.frame_hz = header.rate_hz;
  out.samples.reserve(count * in_frame);
  std::uint32_t sum = 0;
  std::int32_t before = signal.first;
  for (std::size_t i = 0; i < count * in_frame; ++i) {
    bool missing = false;
    std::int32_t raw = raw_sample(bytes, signal.format,
                                  i / in_frame * side_by_side + place + i % in_frame, missing);
    if (signal.format == 8)  // wraps where a file is no recording
      raw = before = static_cast<std::int32_t>(static_cast<std::uint32_t>(before) +
                                               static_cast<std::uint32_t>(raw));
    sum += static_cast<std::uint32_t>(raw);
    out.samples.push_back(missing ? std::numeric_limits<double>::quiet_NaN()
                                  : (static_cast<double>(raw) - signal.baseline) / signal.gain);
  }
  if (signal.has_checksum &&
      static_cast<std::uint16_t>(sum) != static_cast<std::uint16_t>(signal.checksum))
    return refusal(name, fmt::format("a checksum of {}", static_cast<std::int16_t>(sum)),
                   fmt::format("the header's {}", signal.checksum));
  return out;
}

Result<std::vector<BeatAnnotation>> parse_wfdb_beats(std::span<const std::byte> bytes,
                                                     double rate_hz, const std::string& name) {
  std::vector<BeatAnnotation> beats;
  std::int64_t sample = 0;
  const auto word = [&](std::size_t at) {
    return std::to_integer<unsigned>(bytes[at]) | std::to_integer<unsigned>(bytes[at + 1]) << 8;
  };
  for (std::size_t at = 0; at + 2 <= bytes.size();) {
    const unsigned both = word(at);
    const int code = static_cast<int>(both >> 10);
    const unsigned value = both & 0x3FF;
    at += 2;
    if (both == 0) return beats;
    if (code == kSkip) {
      if (at + 4 > bytes.size()) break;
      // The high half first, as on a PDP-11.
      sample += static_cast<std::int32_t>(word(at) << 16 | word(at + 2));
      at += 4;
    } else if (code == kText) {
      at += (value + 1) / 2 * 2;
    } else if (code != kNumber && code != kSubtype && code != kChannel) {
      sample += value;
      if (is_beat(code)) beats.push_back({static_cast<double>(sample) / rate_hz, code});
    }
  }
  return refusal(name, fmt::format("no end mark after {} beats", beats.size()), "two zero bytes");
}

}  // namespace neritic::diver
