#include "tools/neritic/interrupt.hpp"

#include <atomic>
#include <csignal>

#include "engine/core/check.hpp"

namespace neritic::tools {
namespace {

// A signal's handler gets no argument of ours: the one thing here that must be global.
std::atomic<bool> g_listening{false}, g_interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a handler may not lock");

constexpr int kSignals[] = {SIGINT, SIGTERM};

extern "C" void note_interrupt(int) {
  g_interrupted = true;
}

}  // namespace

Interrupt::Interrupt() {
  NERITIC_CHECK(!g_listening.exchange(true), "an Interrupt is alive already");
  g_interrupted = false;
  struct sigaction action {};
  action.sa_handler = note_interrupt;
  // The second takes its ordinary way; calls that wait go on.
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
  for (const int signal : kSignals) sigaction(signal, &action, nullptr);
}

Interrupt::~Interrupt() {
  struct sigaction action {};
  action.sa_handler = SIG_DFL;
  for (const int signal : kSignals) sigaction(signal, &action, nullptr);
  g_listening = false;
}

bool Interrupt::requested() const {
  return g_interrupted;
}

}  // namespace neritic::tools
