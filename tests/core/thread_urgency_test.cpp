#include "engine/core/thread_urgency.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <thread>

namespace neritic {
namespace {

int nice_of_this_thread() {
  return getpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)));
}

TEST(ThreadUrgency, InputGivesWayToStepsAndNobodyGainsPriority) {
  std::thread([] {
    const int before = nice_of_this_thread();
    set_urgency(ThreadUrgency::kSoon);
    EXPECT_EQ(nice_of_this_thread(), before);
    set_urgency(ThreadUrgency::kInput);
    EXPECT_EQ(nice_of_this_thread(), std::max(before, 5));
  }).join();
  // Whoever gave the program less keeps that.
  std::thread([] {
    ASSERT_EQ(setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), 15), 0);
    set_urgency(ThreadUrgency::kSoon);
    EXPECT_EQ(nice_of_this_thread(), 15);
    set_urgency(ThreadUrgency::kInput);
    EXPECT_EQ(nice_of_this_thread(), 15);
  }).join();
}

}  // namespace
}  // namespace neritic
