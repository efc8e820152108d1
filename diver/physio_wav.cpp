// The layout: RIFF, 'WAVE', chunks of id, length and bytes padded to even (IBM and Microsoft 1991,
// Multimedia Programming Interface and Data Specifications 1.0; format 0xFFFE: Microsoft 2003).
#include "diver/physio_wav.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include "engine/core/refusal.hpp"

namespace neritic::diver {
namespace {

constexpr std::uint16_t kPcm = 1, kFloat = 3, kExtensible = 0xFFFE;

std::uint64_t little_endian(std::span<const std::byte> bytes, std::size_t at, std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < count; ++i)
    value |= static_cast<std::uint64_t>(bytes[at + i]) << (8 * i);
  return value;
}

bool has_tag(std::span<const std::byte> bytes, std::size_t at, const char* tag) {
  return at + 4 <= bytes.size() && std::memcmp(bytes.data() + at, tag, 4) == 0;
}

struct WavFormat {
  std::uint16_t kind = 0, channels = 0, bits = 0;
  std::uint32_t rate_hz = 0;
  std::size_t sample_bytes() const { return bits / 8u; }
};

Result<WavFormat> wav_format(std::span<const std::byte> chunk, const std::string& name) {
  if (chunk.size() < 16)
    return refusal(name, fmt::format("'fmt ' of {} bytes", chunk.size()), "16 or more");
  WavFormat format;
  format.kind = static_cast<std::uint16_t>(little_endian(chunk, 0, 2));
  format.channels = static_cast<std::uint16_t>(little_endian(chunk, 2, 2));
  format.rate_hz = static_cast<std::uint32_t>(little_endian(chunk, 4, 4));
  format.bits = static_cast<std::uint16_t>(little_endian(chunk, 14, 2));
  if (format.kind == kExtensible && chunk.size() >= 26)
    format.kind = static_cast<std::uint16_t>(little_endian(chunk, 24, 2));
  const auto one_of = [&](std::initializer_list<int> accepted) {
    return std::ranges::find(accepted, format.bits) != accepted.end();
  };
  if (!(format.kind == kPcm && one_of({8, 16, 24, 32})) &&
      !(format.kind == kFloat && one_of({32, 64})))
    return refusal(name, fmt::format("format {} of {} bit", format.kind, format.bits),
                   "PCM (1) of 8, 16, 24 or 32 bit or float (3) of 32 or 64");
  if (format.channels == 0) return refusal(name, "no channel", "one or more");
  if (format.rate_hz == 0 || format.rate_hz > kMostRate_hz)
    return refusal(name, fmt::format("a rate of {} Hz", format.rate_hz),
                   fmt::format("1 to {:g}", kMostRate_hz));
  return format;
}

double wav_sample(const WavFormat& format, std::span<const std::byte> bytes, std::size_t at) {
  const std::uint64_t raw = little_endian(bytes, at, format.sample_bytes());
  if (format.kind == kFloat) {
    const double value = format.bits == 32 ? std::bit_cast<float>(static_cast<std::uint32_t>(raw))
                                           : std::bit_cast<double>(raw);
    return std::isfinite(value) ? value : std::numeric_limits<double>::quiet_NaN();
  }
  if (format.bits == 8) return (static_cast<double>(raw) - 128.0) / 128.0;  // unsigned, by custom
  const auto shifted = static_cast<std::int64_t>(raw << (64 - format.bits));
  return static_cast<double>(shifted) * 0x1.0p-63;
}

}  // namespace

Result<Recording> parse_wav(std::span<const std::byte> bytes, const std::string& name,
                            std::uint32_t channel) {
  if (!has_tag(bytes, 0, "RIFF") || !has_tag(bytes, 8, "WAVE"))
    return refusal(name, "no RIFF and WAVE", "a .wav file");
  std::optional<WavFormat> format;
  std::optional<std::span<const std::byte>> data;
  for (std::size_t at = 12; at + 8 <= bytes.size() && !data;) {
    const std::size_t length = little_endian(bytes, at + 4, 4), left = bytes.size() - at - 8;
    const auto chunk = bytes.subspan(at + 8, std::min(length, left));
    if (has_tag(bytes, at, "fmt ")) {
      NERITIC_TRY(format, wav_format(chunk, name));
    } else if (has_tag(bytes, at, "data")) {
      // A recorder that was cut off: neither length was filled in, the rest of the file is
      // sound.
      const bool open = length == 0 && little_endian(bytes, 4, 4) + 8 < bytes.size();
      data = open ? bytes.subspan(at + 8) : chunk;
    }
    at += 8 + std::min(length + (length & 1), left);
  }
  if (!format || !data)
    return refusal(name, fmt::format("no '{}' before the end", format ? "data" : "fmt "),
                   "a whole file");
  if (channel >= format->channels)
    return refusal(name, fmt::format("channel {}", channel),
                   fmt::format("0 to {}", format->channels - 1));
  const std::size_t frame = format->sample_bytes() * format->channels;
  const std::size_t count = data->size() / frame;
  if (count == 0) return refusal(name, "no samples", "one or more");
  if (count > kMostSamples)
    return refusal(name, fmt::format("{} samples", count), fmt::format("at most {}", kMostSamples));
  Recording out{fmt::format("channel {}", channel), static_cast<double>(format->rate_hz)};
  out.samples.reserve(count);
  for (std::size_t i = 0; i < count; ++i)
    out.samples.push_back(wav_sample(*format, *data, i * frame + channel * format->sample_bytes()));
  return out;
}

}  // namespace neritic::diver
