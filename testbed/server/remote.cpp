#include "testbed/server/remote.hpp"

#include <algorithm>
#include <cstring>

#include "engine/core/clock.hpp"
#include "engine/core/refusal.hpp"
#include "engine/net/message_pack.hpp"
#include "testbed/server/remote_reply.hpp"
#include "testbed/server/request.hpp"

namespace neritic::testbed {
namespace {

using nlohmann::json;

// The frame that an array's description names, of at least this size in bytes; null: there is none.
const std::vector<std::byte>* frame_of(const Remote::Reply& reply, const json& array,
                                       std::size_t bytes) {
  const auto at = array.find("frame");
  if (at == array.end() || !at->is_number_unsigned()) return nullptr;
  const auto frame = at->get<std::uint64_t>();
  if (frame == 0 || frame >= reply.frames.size()) return nullptr;
  return reply.frames[frame].size() == bytes ? &reply.frames[frame] : nullptr;
}

std::uint64_t number_in(const json& map, const char* key, std::uint64_t most) {
  const auto at = map.find(key);
  if (at == map.end() || !at->is_number_unsigned()) return 0;
  return std::min(at->get<std::uint64_t>(), most);
}

template <class T>
T take(const std::byte*& at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  at += sizeof value;
  return value;
}

}  // namespace

struct Remote::Parts {
  std::unique_ptr<net::ClientSocket> socket;
  std::string where;
  double patience_s = 5.0;
  std::uint64_t next = 1;
  json hello;
};

Remote::Remote(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Remote::~Remote() = default;

Result<std::unique_ptr<Remote>> Remote::connect(const RemoteOptions& options) {
  auto parts = std::make_unique<Parts>();
  NERITIC_TRY(parts->socket, net::ClientSocket::connect(options.socket));
  parts->where = to_text(options.socket.address);
  parts->patience_s = options.patience_s;
  std::unique_ptr<Remote> remote(new Remote(std::move(parts)));
  json hello{{"op", "hello"}, {"protocol", kProtocol}};
  if (!options.name.empty()) hello["name"] = options.name;
  NERITIC_TRY(Reply reply, remote->call(std::move(hello)));
  if (!reply.map.contains("streams") || !reply.map.contains("agents"))
    return refusal(remote->parts_->where, "an answer without streams and agents",
                   "a Neritic server's");
  remote->parts_->hello = std::move(reply.map);
  return remote;
}

const json& Remote::hello() const {
  return parts_->hello;
}

Result<Remote::Reply> Remote::call(json map, const std::vector<net::Bytes>& arrays,
                                   double lasts_s) {
  Parts& parts = *parts_;
  const std::uint64_t id = parts.next++;
  map["id"] = id;
  const std::vector<std::byte> packed = net::pack(map);
  std::vector<net::Bytes> frames{packed};
  frames.insert(frames.end(), arrays.begin(), arrays.end());
  const auto closed = [&] {
    return failure(ErrorCode::kIo,
                   "{}: the connection was closed: the server has ended, or it takes this client "
                   "no more",
                   parts.where);
  };
  constexpr TimeNs kAgain_ns = 1'000'000'000;
  for (const TimeNs until = now_ns() + kAgain_ns; parts.socket->closed() && now_ns() < until;)
    (void)parts.socket->receive(50);  // of a request given up before
  if (parts.socket->closed()) return closed();
  const std::uint64_t closures = parts.socket->closures();
  if (!parts.socket->send(frames))
    return failure(ErrorCode::kIo, "{}: too much data waits to be sent", parts.where);
  const TimeNs until = now_ns() + static_cast<TimeNs>((parts.patience_s + lasts_s) * 1e9);
  for (;;) {
    const TimeNs left = until - now_ns();
    if (left <= 0)
      return failure(ErrorCode::kIo,
                     "{}: no answer in {:g} s: no server, one that is busy, or one with other keys",
                     parts.where, parts.patience_s + lasts_s);
    auto got = parts.socket->receive(static_cast<int>(left / 1'000'000 + 1));
    if (!got && parts.socket->closures() > closures) return closed();
    if (!got) continue;
    Reply reply{{}, std::move(*got)};
    NERITIC_TRY(reply.map,
                net::unpack(reply.frames.front(), {.bytes = 4 << 20, .values = 1 << 20}));
    const std::uint64_t of = number_in(reply.map, "id", ~std::uint64_t{0});
    if (of != id && of != 0) continue;  // of a request given up before
    const auto ok = reply.map.find("ok");
    if (ok != reply.map.end() && ok->is_boolean() && ok->get<bool>()) return reply;
    const auto line = reply.map.find("error");
    return bad_input("{}: {}", parts.where,
                     line != reply.map.end() && line->is_string()
                         ? line->get_ref<const std::string&>()
                         : std::string("refused"));
  }
}

bool Remote::send(json map) {
  map["id"] = 0;
  const std::vector<std::byte> packed = net::pack(map);
  return parts_->socket->send({packed});
}

Result<std::vector<Reading>> readings_in(const Remote::Reply& reply, const char* key) {
  std::vector<Reading> readings;
  const auto array = reply.map.find(key);
  if (array == reply.map.end()) return readings;
  constexpr std::uint64_t kMostRows = 1 << 20;
  const std::uint64_t rows = number_in(*array, "rows", kMostRows),
                      columns = number_in(*array, "columns", Reading::kMostValues);
  const auto* frame = frame_of(reply, *array, rows * (32 + 8 * columns));
  if (!frame) return refusal(key, "rows that do not fit their frame", "a Neritic server's");
  const std::byte* at = frame->data();
  for (std::uint64_t row = 0; row < rows; ++row) {
    Reading reading;
    reading.stream = take<std::uint32_t>(at);
    reading.count =
        std::min<std::uint32_t>(take<std::uint32_t>(at), static_cast<std::uint32_t>(columns));
    reading.sequence = take<std::uint64_t>(at);
    reading.stamp_ns = take<TimeNs>(at);
    reading.arrival_ns = take<TimeNs>(at);
    for (std::uint64_t i = 0; i < columns; ++i) reading.values[i] = take<double>(at);
    readings.push_back(reading);
  }
  return readings;
}

Result<std::vector<Truth>> poses_in(const Remote::Reply& reply) {
  const auto array = reply.map.find("poses");
  constexpr std::uint64_t kMostRows = 1 << 20;
  const std::uint64_t rows = array == reply.map.end() ? 0 : number_in(*array, "rows", kMostRows);
  const auto* frame =
      array == reply.map.end() ? nullptr : frame_of(reply, *array, rows * 13 * sizeof(double));
  if (!frame) return refusal("poses", "rows that do not fit their frame", "a Neritic server's");
  std::vector<Truth> poses(rows);
  const std::byte* at = frame->data();
  for (Truth& pose : poses) {
    for (double& value : pose.position) value = take<double>(at);
    for (double& value : pose.orientation) value = take<double>(at);
    for (double& value : pose.linear_velocity) value = take<double>(at);
    for (double& value : pose.angular_velocity) value = take<double>(at);
  }
  return poses;
}

}  // namespace neritic::testbed
