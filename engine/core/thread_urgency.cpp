#include "engine/core/thread_urgency.hpp"

#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>

namespace neritic {
namespace {

// As in linux/sched/types.h, which glibc's sched.h does not agree with.
struct SchedulingAttributes {
  std::uint32_t size = sizeof(SchedulingAttributes);
  std::uint32_t policy = 0;  // SCHED_OTHER
  std::uint64_t flags = 0;
  std::int32_t nice = 0;
  std::uint32_t priority = 0;
  std::uint64_t slice_ns = 0;  // of SCHED_OTHER: 0.1 to 100 ms; 0: the kernel's own, some 3 ms
  std::uint64_t deadline_ns = 0, period_ns = 0;
  std::uint32_t utilisation_min = 0, utilisation_max = 0;
};

}  // namespace

void set_urgency(ThreadUrgency urgency) {
  constexpr std::int32_t kGivesWay = 5;
  SchedulingAttributes wanted;
  // Whoever started the program with less priority keeps that.
  if (::syscall(SYS_sched_getattr, 0, &wanted, sizeof wanted, 0U) != 0 || wanted.policy != 0)
    return;
  wanted.slice_ns = 100'000;
  if (urgency == ThreadUrgency::kInput) wanted.nice = std::max(wanted.nice, kGivesWay);
  (void)::syscall(SYS_sched_setattr, 0, &wanted, 0U);
}

}  // namespace neritic
