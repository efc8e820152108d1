#include "tools/neritic/interrupt.hpp"

#include <time.h>

#include <atomic>
#include <csignal>
#include <cstdint>

#include "engine/core/check.hpp"

namespace neritic::tools {
namespace {

// A signal's handler gets no argument of ours: the only globals of the program.
std::atomic<bool> g_listening{false};
std::atomic<std::int64_t> g_interrupted_ns{0};  // when; 0: not yet
static_assert(std::atomic<std::int64_t>::is_always_lock_free, "a handler may not lock");

// A terminal that is closed sends SIGHUP; nohup has it ignored.
constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP};

// `timeout` sends its signal twice in a row, to the program and to its group: that is one wish.
constexpr std::int64_t kSameWish_ns = 500'000'000;

bool ignored_hangup(int signal) {
  struct sigaction now {};
  return signal == SIGHUP && sigaction(signal, nullptr, &now) == 0 && now.sa_handler == SIG_IGN;
}

// Everything in here is allowed in a handler (signal-safety(7)).
extern "C" void note_interrupt(int signal) {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  const std::int64_t now_ns = std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
  std::int64_t first_ns = 0;
  if (g_interrupted_ns.compare_exchange_strong(first_ns, now_ns)) return;
  if (now_ns - first_ns < kSameWish_ns) return;
  struct sigaction action {};
  action.sa_handler = SIG_DFL;
  sigaction(signal, &action, nullptr);
  raise(signal);
}

}  // namespace

Interrupt::Interrupt() {
  NERITIC_CHECK(!g_listening.exchange(true), "an Interrupt is alive already");
  g_interrupted_ns = 0;
  struct sigaction action {};
  action.sa_handler = note_interrupt;
  action.sa_flags = SA_RESTART;  // calls that wait go on
  for (const int signal : kSignals)
    if (!ignored_hangup(signal)) sigaction(signal, &action, nullptr);
}

Interrupt::~Interrupt() {
  struct sigaction action {};
  action.sa_handler = SIG_DFL;
  for (const int signal : kSignals)
    if (!ignored_hangup(signal)) sigaction(signal, &action, nullptr);
  g_listening = false;
}

bool Interrupt::requested() const {
  return g_interrupted_ns != 0;
}

}  // namespace neritic::tools
