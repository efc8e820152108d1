#include "engine/net/sender_choice.hpp"

#include <algorithm>

namespace neritic::net {

bool SenderChoice::admits(std::uint64_t sender, TimeNs arrived_ns) {
  newest_ns_ = std::max(newest_ns_, arrived_ns);
  if (!used_ || sender == *used_ || arrived_ns - used_ns_ >= silence_ns_) return true;
  if (arrived_ns - other_ns_ >= silence_ns_) others_ = 0;
  others_ = std::min(others_ + 1, kTold);
  other_ = sender;
  other_ns_ = arrived_ns;
  return false;
}

bool SenderChoice::use(std::uint64_t sender, TimeNs arrived_ns) {
  const bool other = used_ && *used_ != sender;
  if (other) others_ = 0;
  used_ = sender;
  used_ns_ = arrived_ns;
  return other;
}

std::optional<std::uint64_t> SenderChoice::other() const {
  if (others_ < kTold || newest_ns_ - other_ns_ >= silence_ns_) return std::nullopt;
  return other_;
}

}  // namespace neritic::net
