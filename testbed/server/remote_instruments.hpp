// A diver's instruments from a server (PROTOCOL.md, "instruments"), for a HUD in another process or
// on another machine. A thread of its own asks; while nothing answers it connects again and again,
// and the numbers are not known. read() and time_s() may be called on any one thread.
#pragma once

#include "testbed/instruments/instrument_feed.hpp"
#include "testbed/server/remote.hpp"

namespace neritic::testbed {

struct RemoteInstrumentsOptions {
  RemoteOptions remote;
  std::string diver;          // empty: the first one
  double rate_hz = 10.0;      // of questions
  double lost_after_s = 2.0;  // without an answer
};

class RemoteInstruments final : public InstrumentFeed {
 public:
  // The first connection: errors as Remote::connect; kBadInput for a dive without (that) diver.
  static Result<std::unique_ptr<RemoteInstruments>> connect(
      const RemoteInstrumentsOptions& options);
  ~RemoteInstruments() override;

  const std::string& diver() const;
  const std::string& title() const;  // of the scene
  double time_s() const override;
  InstrumentNews read() override;
  bool lost() const;
  std::uint64_t connections() const;  // so far

 private:
  class Thread;
  explicit RemoteInstruments(std::unique_ptr<Thread> thread);
  std::unique_ptr<Thread> thread_;
};

}  // namespace neritic::testbed
