#include "tools/neritic/interrupts.hpp"

#include <ctime>

namespace neritic::tools {

Interrupts::Interrupts() {
  sigemptyset(&asked_);
  sigaddset(&asked_, SIGINT);
  sigaddset(&asked_, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &asked_, &before_);
}

Interrupts::~Interrupts() {
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

bool Interrupts::came() const {
  const timespec at_once{};
  return sigtimedwait(&asked_, nullptr, &at_once) > 0;
}

}  // namespace neritic::tools
