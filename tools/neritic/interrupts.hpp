// Ctrl-C (SIGINT) and SIGTERM as a question instead of an end, while one of these lives: for
// commands that must write what they have. They are blocked and asked for, so that no handler and
// no global is needed. Of the main thread, before others begin (they inherit the block).
#pragma once

#include <csignal>

namespace neritic::tools {

class Interrupts {
 public:
  Interrupts();
  ~Interrupts();  // what is still pending ends the program, as ever
  Interrupts(const Interrupts&) = delete;
  Interrupts& operator=(const Interrupts&) = delete;

  // Whether one came since the last call. A system call, under a microsecond.
  bool came() const;

 private:
  sigset_t asked_{}, before_{};
};

}  // namespace neritic::tools
