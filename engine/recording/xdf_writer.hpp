// XDF, the file of Lab Streaming Layer's recorder: streams of numbers, each sample with its time in
// seconds. Layout: XDF 1.0 (github.com/sccn/xdf, Specifications). One thread.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace neritic::recording {

struct XdfStream {
  std::string name, type;             // "diver/heart", "Heart"
  std::vector<std::string> channels;  // labels
  double rate_hz = 0.0;               // 0: irregular
};

class XdfWriter {
 public:
  XdfWriter();
  // Gives the stream's number, from 1.
  std::uint32_t add_stream(const XdfStream& stream);
  // Precondition: a value a channel.
  void sample(std::uint32_t stream, double time_s, std::span<const double> values);
  // Nothing comes after it.
  void finish();
  // The bytes made since the last call.
  std::string take() { return std::exchange(out_, {}); }

 private:
  struct Open {
    XdfStream stream;
    std::string samples;  // of the chunk that is being filled
    std::uint64_t waiting = 0, count = 0;
    double first_s = 0.0, last_s = 0.0;
  };
  void chunk(std::uint16_t tag, const std::string& content);
  void end_chunk(std::uint32_t stream);

  std::string out_;
  std::vector<Open> streams_;
};

}  // namespace neritic::recording
