// Any bytes as notifications of a heart strap: an Error in one line, or values that are written as
// they were read.
#include <algorithm>

#include "engine/core/check.hpp"
#include "engine/net/heart_strap.hpp"
#include "tests/fuzz/replay.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace neritic;
  using namespace neritic::net;
  const Bytes bytes = fuzz::as_bytes(data, size);
  if (const auto rate = decode_heart_rate(bytes); rate.ok()) {
    const auto again = decode_heart_rate(encode_heart_rate(*rate));
    NERITIC_CHECK(again.ok() && again->bpm == rate->bpm && again->intervals == rate->intervals &&
                      again->contact == rate->contact && again->energy_kj == rate->energy_kj,
                  "{} bpm", rate->bpm);
  } else {
    NERITIC_CHECK(rate.error().message.find('\n') == std::string::npos, "{}", rate.error().message);
  }
  if (const auto ecg = decode_ecg(bytes); ecg.ok()) {
    const std::vector<std::byte> again = encode_ecg(*ecg);
    NERITIC_CHECK(std::ranges::equal(again, bytes), "{} samples", ecg->samples_uv.size());
  }
  return 0;
}
