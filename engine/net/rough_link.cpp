#include "engine/net/rough_link.hpp"

#include "engine/core/random.hpp"

namespace neritic::net {

void RoughLink::send(TimeNs at_ns, std::vector<std::byte> bytes) {
  const RandomKey key{faults_.seed, 0x6c696e6b, sent_++};
  std::uint64_t draw = 0;
  const auto happens = [&](double share) { return random_uniform(key, draw++) < share; };
  if (happens(faults_.loss)) {
    ++lost_;
    return;
  }
  const int copies = happens(faults_.repeat) ? 2 : 1;
  if (happens(faults_.cut)) bytes.resize(random_bits(key, draw++) % (bytes.size() + 1));
  if (happens(faults_.corrupt) && !bytes.empty()) {
    const std::uint64_t bit = random_bits(key, draw++) % (8 * bytes.size());
    bytes[bit / 8] ^= static_cast<std::byte>(1U << bit % 8);
  }
  if (happens(faults_.garbage)) {
    bytes.resize(random_bits(key, draw++) % 256);
    for (std::byte& byte : bytes) byte = static_cast<std::byte>(random_bits(key, draw++));
  }
  for (int i = 0; i < copies; ++i) {
    const double way_s = faults_.delay_s + faults_.jitter_s * random_uniform(key, draw++);
    waiting_.push({at_ns + static_cast<TimeNs>(1e9 * way_s), queued_++, bytes});
  }
}

RoughLink::Packet RoughLink::take_next() {
  Packet packet = waiting_.top();
  waiting_.pop();
  return packet;
}

}  // namespace neritic::net
