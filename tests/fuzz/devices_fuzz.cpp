// Any bytes as packets of a lab's devices, in a row, of one adapter: each packet is counted once,
// and what comes out is finite and plausible. The first byte chooses the device, then each packet
// has its length before it, in two bytes.
#include "diver/segments.hpp"
#include "engine/core/check.hpp"
#include "engine/scene/source_settings.hpp"
#include "testbed/devices/gaze_adapter.hpp"
#include "testbed/devices/jacket_adapter.hpp"
#include "testbed/devices/microphone_adapter.hpp"
#include "testbed/devices/strap_adapter.hpp"
#include "testbed/devices/suit_adapter.hpp"
#include "tests/fuzz/replay.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace neritic;
  using namespace neritic::testbed;
  const net::Bytes bytes = fuzz::as_bytes(data, size);
  if (bytes.size() < 2) return 0;
  StreamTable streams;
  streams.add_diver("diver");
  SampleInbox inbox(streams, 64);
  const SourceId source = inbox.open("device", 15 * kSecond_ns).value();
  Outlet out(inbox, source, streams, 0);
  std::unique_ptr<DeviceAdapter> adapter;
  switch (std::to_integer<int>(bytes[0]) % 6) {
    case 0:
      adapter = std::make_unique<SuitAdapter>(0, false);
      break;
    case 1:
      adapter = std::make_unique<SuitAdapter>(0, true);
      break;
    case 2:
      adapter = std::make_unique<StrapAdapter>();
      break;
    case 3:
      adapter = std::make_unique<JacketAdapter>();
      break;
    case 4:
      adapter = std::make_unique<MicrophoneAdapter>(8000.0);
      break;
    default:
      adapter = std::make_unique<GazeAdapter>();
  }
  TimeNs now = kSecond_ns;
  for (std::size_t at = 1; at + 2 <= bytes.size();) {
    const std::size_t length =
        std::min<std::size_t>(net::big_endian<std::uint16_t>(bytes, at), bytes.size() - at - 2);
    adapter->take(bytes.subspan(at + 2, length), length % 31 == 30, now, out);
    now += static_cast<TimeNs>(length) * kMillisecond_ns;
    adapter->tick(now, out);
    at += 2 + length;
    for (const Sample& sample : inbox.drain())
      NERITIC_CHECK(all_finite(sample.payload) && plausible(sample.payload), "{}",
                    name_of(sample.kind()));
  }
  const net::LinkCounts& c = adapter->counts();
  NERITIC_CHECK(c.datagrams == c.used + c.malformed + c.unused + c.repeated + c.older, "{}",
                c.datagrams);
  // The same bytes as a line of a scene.
  const auto line = scene::parse_device(std::string_view(
      reinterpret_cast<const char*>(bytes.data()), std::min<std::size_t>(bytes.size(), 80)));
  NERITIC_CHECK(line.ok() || line.error().message.find("accepted: ") != std::string::npos, "{}",
                line.ok() ? "" : line.error().message);
  return 0;
}
