#include "testbed/devices/suit_adapter.hpp"

#include <algorithm>

namespace neritic::testbed {
namespace {

constexpr std::uint64_t kTroubleAfter = 50;  // datagrams or frames in a row
constexpr std::array kMagic{std::byte{'M'}, std::byte{'X'}, std::byte{'T'}, std::byte{'P'}};

}  // namespace

void SuitAdapter::receive(net::Bytes bytes, bool cut, TimeNs arrived_ns, Outlet& out) {
  if (!stream_) return datagram(bytes, cut, [&] { take_datagram(bytes, arrived_ns, out); });
  if (cut) {
    if (!left_.empty()) datagram(left_, true, [] {});
    left_.clear();
    return;
  }
  left_.insert(left_.end(), bytes.begin(), bytes.end());
  std::size_t at = 0;
  while (true) {
    const net::Bytes rest = net::Bytes(left_).subspan(at);
    const auto length = net::mxtp_length(rest);
    if (!length.ok()) {
      // On to what looks like the next datagram.
      const auto next = std::search(rest.begin() + 1, rest.end(), kMagic.begin(), kMagic.end());
      const auto skipped = static_cast<std::size_t>(next - rest.begin());
      datagram(rest.first(skipped), true, [] {});
      at += skipped;
    } else if (*length == 0 || *length > rest.size()) {
      break;
    } else {
      const net::Bytes whole = rest.first(*length);
      datagram(whole, false, [&] { take_datagram(whole, arrived_ns, out); });
      at += *length;
    }
  }
  left_.erase(left_.begin(), left_.begin() + static_cast<std::ptrdiff_t>(at));
}

void SuitAdapter::take_datagram(net::Bytes bytes, TimeNs arrived_ns, Outlet& out) {
  const auto datagram = net::decode_mxtp(bytes);
  if (!datagram.ok()) {
    ++(datagram.error().code == ErrorCode::kUnsupported ? counts_.unused : counts_.malformed);
    return;
  }
  type_ = datagram->header.type;
  others_ = type_ == 2 ? 0 : others_ + 1;
  const net::SuitFrame* frame = frames_.take(*datagram, arrived_ns, counts_);
  if (!frame) return;
  const TimeNs sent_ns = static_cast<TimeNs>(frame->time_ms) * kMillisecond_ns;
  if (frame->restarted) clock_.restart();
  clock_.add(sent_ns, frame->first_ns);
  const TimeNs captured_ns = clock_.to_host(sent_ns);
  BodyJoints body;
  body.joints = joints_of(*frame);
  out.send(body, captured_ns, arrived_ns);
  out.send(hands_of(*frame, body.joints), captured_ns, arrived_ns);
}

std::string SuitAdapter::trouble() const {
  if (others_ >= kTroubleAfter)
    return fmt::format("it sends type {:02}; used: 02, position and orientation (quaternion)",
                       type_);
  if (frames_.incomplete() >= kTroubleAfter)
    return fmt::format("no frame has all {} segments of the body", net::kMxtpBodySegments);
  return frames_.trouble();
}

}  // namespace neritic::testbed
