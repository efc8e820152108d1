#include "engine/net/mxtp.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "engine/core/refusal.hpp"

namespace neritic::net {
namespace {

constexpr std::string_view kSuitMagic = "MXTP";
// Sizes of an item on the wire, for types whose items all have one size.
constexpr std::size_t kEulerBytes = 28, kPoseBytes = 32, kJointBytes = 20, kLinearBytes = 40,
                      kAngularBytes = 44;

int digit(std::byte byte) {
  const int value = std::to_integer<int>(byte) - '0';
  return value >= 0 && value <= 9 ? value : -1;
}

Result<MxtpHeader> decode_header(Bytes bytes) {
  if (bytes.size() < kMxtpHeader)
    return refusal("MXTP", fmt::format("{} bytes", bytes.size()), "24 or more");
  const int tens = digit(bytes[4]), ones = digit(bytes[5]);
  for (std::size_t i = 0; i < kSuitMagic.size(); ++i)
    if (bytes[i] != static_cast<std::byte>(kSuitMagic[i]) || tens < 0 || ones < 0)
      return refusal("MXTP", "another first word", "MXTP and a type of two digits");
  MxtpHeader header;
  header.type = 10 * tens + ones;
  header.sample = big_endian<std::uint32_t>(bytes, 6);
  const auto datagram = std::to_integer<std::uint8_t>(bytes[10]);
  header.datagram = datagram & 0x7f;
  header.last = (datagram & 0x80) != 0;
  header.items = std::to_integer<std::uint8_t>(bytes[11]);
  header.time_ms = big_endian<std::uint32_t>(bytes, 12);
  header.character = std::to_integer<std::uint8_t>(bytes[16]);
  header.body_segments = std::to_integer<std::uint8_t>(bytes[17]);
  header.props = std::to_integer<std::uint8_t>(bytes[18]);
  header.finger_segments = std::to_integer<std::uint8_t>(bytes[19]);
  header.payload = big_endian<std::uint16_t>(bytes, 22);
  return header;
}

// Reads one item after the other.
class ItemReader {
 public:
  explicit ItemReader(Bytes bytes) : bytes_(bytes) {}
  std::uint32_t whole() {
    const auto value = big_endian<std::uint32_t>(bytes_, at_);
    at_ += 4;
    return value;
  }
  template <std::size_t N>
  std::array<float, N> floats() {
    std::array<float, N> values;
    for (float& value : values) {
      value = big_endian_float(bytes_, at_);
      finite_ = finite_ && std::isfinite(value);
      at_ += 4;
    }
    return values;
  }
  Float4 rotation() {
    const Float4 q = floats<4>();
    const float length2 = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    finite_ = finite_ && length2 > 0.25F && length2 < 4.0F;
    return q;
  }
  // Whether all since the last call were finite.
  bool take_finite() { return std::exchange(finite_, true); }

 private:
  Bytes bytes_;
  std::size_t at_ = 0;
  bool finite_ = true;
};

MxtpEuler read(ItemReader& in, MxtpEuler) {
  return {in.whole(), in.floats<3>(), in.floats<3>()};
}
MxtpPose read(ItemReader& in, MxtpPose) {
  return {in.whole(), in.floats<3>(), in.rotation()};
}
// A point is a segment's number times 256, and the point's.
MxtpJoint read(ItemReader& in, MxtpJoint) {
  const std::uint32_t parent = in.whole(), child = in.whole();
  return {parent >> 8, parent & 255, child >> 8, child & 255, in.floats<3>()};
}
MxtpLinear read(ItemReader& in, MxtpLinear) {
  return {in.whole(), in.floats<3>(), in.floats<3>(), in.floats<3>()};
}
MxtpAngular read(ItemReader& in, MxtpAngular) {
  return {in.whole(), in.rotation(), in.floats<3>(), in.floats<3>()};
}
MxtpTracker read(ItemReader& in, const MxtpTracker& kind) {
  MxtpTracker item{.id = in.whole(), .rotation = in.rotation(), .whole = kind.whole};
  item.free_acceleration_m_s2 = in.floats<3>();
  if (kind.whole) item.acceleration_m_s2 = in.floats<3>(), item.turn_rate_rad_s = in.floats<3>();
  item.magnetic_field = in.floats<3>();
  return item;
}
MxtpMassCentre read(ItemReader& in, const MxtpMassCentre& kind) {
  MxtpMassCentre item{.position_m = in.floats<3>(), .moving = kind.moving};
  if (kind.moving) item.velocity_m_s = in.floats<3>(), item.acceleration_m_s2 = in.floats<3>();
  return item;
}

std::uint32_t number_of(const auto& item) {
  if constexpr (requires { item.id; }) return item.id;
  if constexpr (requires { item.child_segment; })
    return std::min(item.parent_segment, item.child_segment);
  return 1;
}

// Items of one size, like `kind`.
template <class Item>
Status read_items(Bytes payload, const Item& kind, MxtpDatagram& out) {
  ItemReader in(payload);
  std::vector<Item> items;
  items.reserve(out.header.items);
  for (int i = 0; i < out.header.items; ++i) {
    const Item item = read(in, kind);
    if (number_of(item) == 0) return refusal("MXTP", "segment 0", "numbers from 1");
    if (in.take_finite())
      items.push_back(item);
    else
      ++out.refused_items;
  }
  out.items = std::move(items);
  return {};
}

Error wrong_size(const MxtpHeader& header, std::size_t bytes, std::string_view accepted) {
  return refusal("MXTP",
                 fmt::format("{} bytes for {} items of type {}", bytes, header.items, header.type),
                 accepted);
}

template <class Item>
Status read_sized(Bytes payload, std::size_t item_bytes, const Item& kind, MxtpDatagram& out) {
  if (payload.size() != item_bytes * out.header.items)
    return wrong_size(out.header, payload.size(), fmt::format("{} each", item_bytes));
  return read_items(payload, kind, out);
}

// "16:00:31.123", in newer programs after its length.
Status read_time_code(Bytes payload, MxtpDatagram& out) {
  constexpr std::size_t kLength = 12;
  const bool prefixed =
      payload.size() == kLength + 4 && big_endian<std::uint32_t>(payload, 0) == kLength;
  if (!prefixed && payload.size() != kLength)
    return wrong_size(out.header, payload.size(), "12 of a time code, or its length and 12");
  MxtpTimeCode code;
  for (const std::byte byte : payload.last(kLength)) {
    const char c = std::to_integer<char>(byte);
    if (!((c >= '0' && c <= '9') || c == ':' || c == '.' || c == ';'))
      return refusal("MXTP", "a time code of other characters", "digits, : and .");
    code.text += c;
  }
  out.items = std::move(code);
  return {};
}

std::optional<std::size_t> fixed_item_bytes(int type) {
  switch (type) {
    case 1:
      return kEulerBytes;
    case 2:
      return kPoseBytes;
    case 20:
      return kJointBytes;
    case 21:
      return kLinearBytes;
    case 22:
      return kAngularBytes;
    default:
      return {};
  }
}

Status read_payload(Bytes payload, MxtpDatagram& out) {
  const std::size_t items = out.header.items;
  switch (out.header.type) {
    case 1:
      return read_sized(payload, kEulerBytes, MxtpEuler{}, out);
    case 2:
      return read_sized(payload, kPoseBytes, MxtpPose{}, out);
    case 20:
      return read_sized(payload, kJointBytes, MxtpJoint{}, out);
    case 21:
      return read_sized(payload, kLinearBytes, MxtpLinear{}, out);
    case 22:
      return read_sized(payload, kAngularBytes, MxtpAngular{}, out);
    case 23: {
      const bool whole = payload.size() == 68 * items;
      return read_sized(payload, whole ? 68 : 44, MxtpTracker{.whole = whole}, out);
    }
    case 24: {
      const bool moving = payload.size() == 36 * items;
      return read_sized(payload, moving ? 36 : 12, MxtpMassCentre{.moving = moving}, out);
    }
    case 25:
      return read_time_code(payload, out);
    default:
      return failure(ErrorCode::kUnsupported, "MXTP: found type {:02}; accepted: 01, 02, 20 to 25",
                     out.header.type);
  }
}

}  // namespace

Result<MxtpDatagram> decode_mxtp(Bytes bytes) {
  NERITIC_TRY(const MxtpHeader header, decode_header(bytes));
  const std::size_t there = bytes.size() - kMxtpHeader;
  if (header.payload != 0 && header.payload != there)
    return refusal("MXTP", fmt::format("a payload of {} bytes, {} present", header.payload, there),
                   "as many as the header says");
  MxtpDatagram out{header, {}, 0};
  NERITIC_TRY_STATUS(read_payload(bytes.subspan(kMxtpHeader), out));
  return out;
}

Result<std::size_t> mxtp_length(Bytes stream) {
  if (stream.size() < kMxtpHeader) return std::size_t{0};
  NERITIC_TRY(const MxtpHeader header, decode_header(stream));
  if (header.payload != 0) return kMxtpHeader + header.payload;
  if (const auto item_bytes = fixed_item_bytes(header.type))
    return kMxtpHeader + *item_bytes * header.items;
  const auto next = std::search(
      stream.begin() + kMxtpHeader, stream.end(), kSuitMagic.begin(), kSuitMagic.end(),
      [](std::byte byte, char letter) { return byte == static_cast<std::byte>(letter); });
  const auto end = static_cast<std::size_t>(next - stream.begin());
  if (end < stream.size()) return end;
  if (stream.size() > kMxtpMostBytes)
    return refusal("MXTP", fmt::format("{} bytes without an end", stream.size()),
                   fmt::format("up to {} before the next datagram", kMxtpMostBytes));
  return std::size_t{0};
}

void put_mxtp_number(std::span<std::byte> datagram, std::uint32_t sample, std::uint32_t time_ms) {
  NERITIC_CHECK(datagram.size() >= kMxtpHeader, "{} bytes", datagram.size());
  const auto put = [&](std::size_t at, std::uint32_t value) {
    for (std::size_t i = 0; i < 4; ++i)
      datagram[at + i] = static_cast<std::byte>(value >> (24 - 8 * i));
  };
  put(6, sample);
  put(12, time_ms);
}

std::vector<std::byte> encode_mxtp(MxtpHeader header, std::span<const MxtpPose> poses) {
  NERITIC_CHECK(poses.size() <= 255, "{} poses", poses.size());
  std::vector<std::byte> out;
  out.reserve(kMxtpHeader + 32 * poses.size());
  for (const char c : kSuitMagic) out.push_back(static_cast<std::byte>(c));
  out.push_back(static_cast<std::byte>('0'));
  out.push_back(static_cast<std::byte>('2'));
  put_big(out, header.sample);
  put_big(out, static_cast<std::uint8_t>(header.datagram | (header.last ? 0x80 : 0)));
  put_big(out, static_cast<std::uint8_t>(poses.size()));
  put_big(out, header.time_ms);
  for (const std::uint8_t byte :
       {header.character, header.body_segments, header.props, header.finger_segments})
    put_big(out, byte);
  put_big(out, std::uint16_t{0});
  put_big(out, static_cast<std::uint16_t>(32 * poses.size()));
  for (const MxtpPose& pose : poses) {
    put_big(out, pose.id);
    for (const float v : pose.position_m) put_big_float(out, v);
    for (const float v : pose.rotation) put_big_float(out, v);
  }
  return out;
}

}  // namespace neritic::net
