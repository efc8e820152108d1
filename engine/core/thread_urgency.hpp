// The scheduling of the calling thread against others of the machine. Linux; needs no rights, and
// where the kernel refuses, the thread runs as any other.
#pragma once

namespace neritic {

enum class ThreadUrgency {
  // Short work at fixed times, such as a step of physics: runs soon after it wakes, also on a
  // machine that is busy (a short slice, Linux 6.12 and later).
  kSoon,
  // For what devices and clients send: soon too, and it gives way to steps.
  kInput,
};

void set_urgency(ThreadUrgency urgency);

}  // namespace neritic
