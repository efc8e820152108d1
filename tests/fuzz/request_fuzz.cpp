// Any bytes as a client's request: an Error in one short line, or a request within its limits.
#include <cmath>

#include "engine/core/check.hpp"
#include "testbed/server/request.hpp"
#include "tests/fuzz/replay.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace neritic;
  using namespace neritic::testbed;
  const auto bytes = fuzz::as_bytes(data, size);
  // The first byte says how much of the rest is the second frame.
  const std::size_t state =
      size > 0 && data[0] < 128 ? std::min<std::size_t>(data[0], size - 1) : 0;
  std::vector<net::Bytes> frames{bytes.subspan(0, size - state)};
  if (state > 0) frames.push_back(bytes.subspan(size - state));
  std::optional<std::uint64_t> id;
  const auto request = parse_request(frames, id);
  if (!request.ok()) {
    const std::string& message = request.error().message;
    NERITIC_CHECK(message.size() < 1000 && message.find('\n') == message.npos, "{}", message);
    return 0;
  }
  NERITIC_CHECK(request->steps <= kMostSteps && request->wait_s <= kMostWait_s &&
                    request->values.size() <= kMostValues && request->stream.size() <= kMostText,
                "{}", name_of(request->op));
  for (const double value : request->values) NERITIC_CHECK(std::isfinite(value), "{}", value);
  return 0;
}
