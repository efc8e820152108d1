#include "testbed/devices/outlet.hpp"

#include <algorithm>

namespace neritic::testbed {

void Outlet::send(const Payload& payload, TimeNs captured_ns, TimeNs arrived_ns) {
  const auto kind = static_cast<PayloadKind>(payload.index());
  TimeNs& newest_ns = captured_ns_[payload.index()];
  std::uint64_t& sequence = sequences_[payload.index()];
  captured_ns = std::min(captured_ns, arrived_ns);
  if (sequence > 0) captured_ns = std::max(captured_ns, newest_ns);
  newest_ns = captured_ns;
  const SampleVerdict verdict =
      inbox_.push({{streams_.id(OwnerSort::kDiver, diver_, kind), source_, sequence++, captured_ns,
                    std::max(arrived_ns, captured_ns)},
                   payload});
  ++sent_;
  if (verdict == SampleVerdict::kAccepted) ++accepted_;
}

}  // namespace neritic::testbed
