// `neritic dive --markers`: lines of text that come by UDP while a dive runs (`neritic study` sends
// them, any program may) go into its recording, as messages of /markers, and to Lab Streaming Layer
// where its library is installed. A step sink: the stepping thread; each marker has the scene's
// time of its arrival, to the microsecond as the kernel stamped it.
#pragma once

#include "engine/net/socket.hpp"
#include "testbed/devices/lsl_outlet.hpp"
#include "testbed/record/recording_file.hpp"

namespace neritic::tools {

class Markers final : public testbed::StepSink {
 public:
  static constexpr std::size_t kMostText = 1024;
  // place: a port of this machine, or udp://ADDRESS:PORT. recording: borrowed; nullptr: none.
  static Result<std::unique_ptr<Markers>> open(const std::string& place,
                                               testbed::RecordingFile* recording);
  Status accept(const sim::Snapshot<testbed::PhysicsState>& step,
                std::span<const testbed::Sample> outputs) override;
  Status finish() override { return {}; }
  // Where they come in and go to, in words.
  const std::string& words() const { return words_; }

 private:
  Markers(net::UdpReceiver receiver, testbed::RecordingFile* recording);
  void take(net::Bytes bytes, bool cut, std::int64_t stamp_ns, std::int64_t log_ns,
            TimeNs waited_ns);
  void mark(const std::string& text, std::int64_t stamp_ns, std::int64_t log_ns, TimeNs waited_ns);

  net::UdpReceiver receiver_;
  testbed::RecordingFile* recording_;
  std::unique_ptr<testbed::LslOutlet> outlet_;
  std::string words_;
  std::optional<std::uint16_t> channel_;
  std::uint32_t sequence_ = 0;
};

}  // namespace neritic::tools
