// Any bytes as a WFDB header, and as the signals and the annotations of a record: an Error in one
// line, or finite samples and times.
#include <cmath>
#include <string_view>

#include "diver/physio_wfdb.hpp"
#include "engine/core/check.hpp"
#include "tests/fuzz/replay.hpp"

namespace {

using neritic::diver::WfdbHeader;

void check_message(const std::string& message) {
  NERITIC_CHECK(message.starts_with("fuzz:") && message.find('\n') == message.npos, "{}", message);
}

void read_signals(const WfdbHeader& header, std::span<const std::byte> bytes) {
  for (std::uint32_t channel = 0; channel <= header.signals.size(); ++channel) {
    const auto signal = neritic::diver::parse_wfdb_signal(header, channel, bytes, "fuzz");
    if (!signal.ok()) {
      check_message(signal.error().message);
      continue;
    }
    NERITIC_CHECK(signal->samples.size() <= bytes.size(), "{}", signal->samples.size());
    for (const double s : signal->samples) NERITIC_CHECK(!std::isinf(s), "{}", s);
  }
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace neritic;
  const auto bytes = fuzz::as_bytes(data, size);
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto header = diver::parse_wfdb_header(text, "fuzz");
  if (header.ok())
    read_signals(*header, bytes);
  else
    check_message(header.error().message);
  for (const int format : {212, 16}) {
    WfdbHeader plain;
    plain.signals = {{"a", "I", format}, {"a", "II", format}};
    read_signals(plain, bytes);
  }
  const auto beats = diver::parse_wfdb_beats(bytes, 360.0, "fuzz");
  if (!beats.ok()) {
    check_message(beats.error().message);
    return 0;
  }
  for (const auto& beat : *beats)
    NERITIC_CHECK(std::isfinite(beat.time_s) && diver::is_beat(beat.code), "{}", beat.code);
  return 0;
}
