#include "testbed/world/arrivals.hpp"

#include <cmath>

#include "engine/core/random.hpp"

namespace neritic::testbed {

std::optional<TimeNs> arrival_of(const LinkOptions& link, std::uint64_t seed, std::uint32_t stream,
                                 std::uint64_t sequence, TimeNs sent_ns) {
  if (link.direct()) return sent_ns;
  const RandomKey key{seed, 0x6172726976616cull ^ stream, sequence};  // "arrival"
  if (link.loss > 0.0 && random_uniform(key, 0) < link.loss) return std::nullopt;
  const double late_s = link.delay_s + link.jitter_s * random_uniform(key, 1);
  return sent_ns + std::llround(late_s * 1e9);
}

}  // namespace neritic::testbed
