#include "tools/neritic/markers.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/log.hpp"
#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"
#include "engine/recording/cdr.hpp"
#include "engine/recording/ros_types.hpp"

namespace neritic::tools {
using namespace testbed;
namespace {

constexpr std::size_t kAtOnce = 64;  // in a step
constexpr const char* kStream = "neritic markers";

Result<Address> marker_address(const std::string& place) {
  const bool port =
      !place.empty() && std::ranges::all_of(place, [](char c) { return c >= '0' && c <= '9'; });
  auto parsed = parse_address(port ? "udp://127.0.0.1:" + place : place);
  if (!parsed.ok() || parsed->transport != Transport::kUdp)
    return refusal("--markers", fmt::format("'{}'", place),
                   "a port, 1 to 65535, or udp://ADDRESS:PORT");
  return std::move(parsed).value();
}

}  // namespace

Markers::Markers(net::UdpReceiver receiver, RecordingFile* recording)
    : receiver_(std::move(receiver)), recording_(recording) {}

Result<std::unique_ptr<Markers>> Markers::open(const std::string& place, RecordingFile* recording) {
  NERITIC_TRY(const Address address, marker_address(place));
  auto receiver = net::UdpReceiver::bind(address);
  if (!receiver.ok()) return Error{receiver.error().code, "--markers: " + receiver.error().message};
  std::unique_ptr<Markers> out(new Markers(std::move(receiver).value(), recording));
  auto outlet = LslOutlet::create(kStream);
  if (outlet.ok())
    out->outlet_ = std::move(outlet).value();
  else if (!recording)
    return refusal("--markers",
                   "no --record, and no Lab Streaming Layer: " + outlet.error().message,
                   "one of them");
  out->words_ =
      fmt::format("markers at {}: to {}", to_text(address),
                  !recording     ? "Lab Streaming Layer"
                  : out->outlet_ ? "the recording and Lab Streaming Layer"
                                 : "the recording alone (" + outlet.error().message + ")");
  return out;
}

Status Markers::accept(const sim::Snapshot<PhysicsState>& step, std::span<const Sample>) {
  const auto log_ns = static_cast<std::int64_t>(std::llround(1e9 * step.time_s));
  (void)receiver_.receive(
      [&](net::Bytes bytes, bool cut) {
        const TimeNs waited_ns = receiver_.waited_ns();
        take(bytes, cut, std::max<std::int64_t>(log_ns - waited_ns, 0), log_ns, waited_ns);
      },
      kAtOnce);
  return {};
}

void Markers::take(net::Bytes bytes, bool cut, std::int64_t stamp_ns, std::int64_t log_ns,
                   TimeNs waited_ns) {
  if (bytes.empty() && !cut) return;  // a sender that looks whether somebody listens
  if (cut || bytes.size() > kMostText) {
    log_warn("--markers: found {}{} bytes; accepted: 1 to {}", cut ? "more than " : "",
             bytes.size(), kMostText);
    return;
  }
  std::string_view left(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  while (!left.empty()) {
    std::string_view line = left.substr(0, left.find('\n'));
    left.remove_prefix(std::min(line.size() + 1, left.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (!line.empty()) mark(printable(line, kMostText), stamp_ns, log_ns, waited_ns);
  }
}

void Markers::mark(const std::string& text, std::int64_t stamp_ns, std::int64_t log_ns,
                   TimeNs waited_ns) {
  if (outlet_) outlet_->send(text, waited_ns);
  if (!recording_ || recording_->failed()) return;
  recording::McapOut& out = recording_->out();
  if (!channel_)
    channel_ =
        out.add_channel({out.add_schema(recording::own_schema(
                             "neritic_msgs/msg/Marker", "std_msgs/Header header\nstring text\n")),
                         "/markers",
                         "cdr",
                         {}});
  std::string message;
  recording::CdrWriter cdr(message);
  cdr.header(stamp_ns, "");
  cdr.text(text);
  out.message({*channel_, sequence_++, static_cast<std::uint64_t>(log_ns),
               static_cast<std::uint64_t>(stamp_ns), std::as_bytes(std::span(message))});
}

}  // namespace neritic::tools
