// Ctrl-C in the middle of a long run: what is under way is finished, what accumulated is written,
// and one line says how to go on. A second one, half a second later or more, ends the program at
// once.
#pragma once

namespace neritic::tools {

// While one lives, the first SIGINT, SIGTERM or SIGHUP (unless that is ignored) only sets a flag.
// One at a time; made and destroyed on one thread, asked from any.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  bool requested() const;
};

}  // namespace neritic::tools
