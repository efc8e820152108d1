// A budget that fills with time, up to a second of it. One thread.
#pragma once

#include <algorithm>

#include "engine/core/clock.hpp"

namespace neritic::net {

class Rate {
 public:
  explicit Rate(double per_s) : per_s_(per_s), left_(per_s) {}
  // False, and nothing is taken, where less is left.
  bool take(double amount, TimeNs now) {
    left_ = std::min(per_s_, left_ + per_s_ * 1e-9 * static_cast<double>(now - last_ns_));
    last_ns_ = now;
    if (left_ < amount) return false;
    left_ -= amount;
    return true;
  }

 private:
  double per_s_, left_;
  TimeNs last_ns_ = 0;
};

}  // namespace neritic::net
