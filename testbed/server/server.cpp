#include "testbed/server/server.hpp"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>

#include "engine/core/refusal.hpp"
#include "engine/core/thread_urgency.hpp"
#include "engine/net/message_pack.hpp"
#include "testbed/server/client_mail.hpp"

namespace neritic::testbed {
namespace {

using nlohmann::json;

constexpr int kWait_ms = 50;                // that the thread waits for messages at most
constexpr const char* kUnnamed = "client";  // as in process

json described(const ServedFacts& facts) {
  json agents = json::array(), streams = json::array();
  for (const AgentInfo& one : facts.agents) {
    json thrusters = json::array();
    for (const auto& [least, most] : one.thruster_n) thrusters.push_back({least, most});
    agents.push_back({{"name", one.name},
                      {"kind", one.kind},
                      {"thruster_n", thrusters},
                      {"takes_pwm", one.takes_pwm},
                      {"modem", one.modem},
                      {"has_mission", one.has_mission}});
  }
  constexpr const char* kSorts[] = {"reading", "input", "image"};
  for (const StreamInfo& one : facts.streams) {
    json fields = json::array();
    for (const StreamField& field : one.fields) fields.push_back({field.name, field.count});
    streams.push_back({{"name", one.name},
                       {"owner", one.owner},
                       {"kind", one.kind},
                       {"frame", one.frame},
                       {"sort", kSorts[static_cast<std::size_t>(one.sort)]},
                       {"fields", fields},
                       {"rate_hz", one.rate_hz},
                       {"encoding", one.encoding}});
  }
  return {{"protocol", kProtocol},        {"version", facts.version}, {"title", facts.title},
          {"path", facts.path},           {"seed", facts.seed},       {"step_s", facts.step_s},
          {"real_time", facts.real_time}, {"agents", agents},         {"streams", streams},
          {"objects", facts.objects}};
}

// A source with its counts; null: not known.
json described(const SourceInfo& source) {
  json map{{"name", source.name}, {"health", source.health}};
  for (const auto& [name, count] : named_counts(source.counts)) map[std::string(name)] = count;
  if (!source.link) return map;
  const SourceInfo::Link& link = *source.link;
  const auto known = [](const std::optional<double>& value) {
    return value ? json(*value) : json(nullptr);
  };
  map["link"] = {{"device", link.device},
                 {"where", link.where},
                 {"rate_hz", link.rate_hz},
                 {"lost", link.lost},
                 {"clock_offset_s", known(link.clock_offset_s)},
                 {"clock_drift_ppm", known(link.clock_drift_ppm)},
                 {"jitter_ms", known(link.jitter_ms)},
                 {"trouble", link.trouble}};
  return map;
}

}  // namespace

class Server::Network {
 public:
  Network(ServedFacts facts, HandOff& hand_off, std::unique_ptr<net::ServerSocket> socket,
          std::unique_ptr<net::ArrayRing> ring)
      : facts_(std::move(facts)),
        hand_off_(hand_off),
        socket_(std::move(socket)),
        ring_(std::move(ring)),
        newest_(facts_.streams.size()),
        described_(described(facts_)) {
    hand_off_.wake_network = [this] { socket_->wake(); };
    thread_ = std::thread([this] { run(); });
  }
  ~Network() {
    stop_ = true;
    socket_->wake();
    thread_.join();
  }
  Address address() const { return socket_->address(); }
  Counts counts() const {
    const std::lock_guard lock(mutex_);
    return told_counts_;
  }

 private:
  struct Client {
    std::string name;
    std::string participant;  // whom it is, where it joined; empty: nobody
    bool greeted = false;
    ClientMail mail;
  };

  void run();
  void hear(const net::ClientMessage& message);
  void gone(ClientId client);
  void answer_here(ClientId id, Client& client, const Request& request);
  void greet(ClientId id, Client& client, const Request& request);
  void hand_over(ClientId id, Client& client, Request request);
  void told(Told told);
  void put_news(News& news);
  void answer(const Answer& answer);
  void end_observing(TimeNs now);
  enum class Known { kYes, kNo };
  // request: absent if its number cannot be read; 0: it wants no answer.
  void refuse(ClientId id, std::optional<std::uint64_t> request, const std::string& line,
              Known known = Known::kYes);
  // Sends the map with the client's mail.
  void deliver(ClientId id, Client& client, json map, Outgoing message, bool mail);
  void send(ClientId id, const json& map, Outgoing message);
  void transmit(ClientId id, const json& map, Outgoing message);

  const ServedFacts facts_;
  HandOff& hand_off_;
  std::unique_ptr<net::ServerSocket> socket_;
  std::unique_ptr<net::ArrayRing> ring_;  // null: none
  std::map<ClientId, Client> clients_;
  NewestTable newest_;
  const json described_;
  std::uint64_t step_ = 0, dropped_ = 0;
  std::int64_t time_ns_ = 0;
  std::string clock_;
  Counts counts_;  // the thread's
  mutable std::mutex mutex_;
  Counts told_counts_;    // guarded by mutex_
  std::deque<Ask> left_;  // clients that left, while the queue was full
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

void Server::Network::run() {
  set_urgency(ThreadUrgency::kInput);
  const net::ServerSocket::Events events{[this](const auto& message) { hear(message); },
                                         [this](ClientId client) { gone(client); }};
  while (!stop_) {
    socket_->serve(kWait_ms, events);
    for (Told& one : hand_off_.told.take(kTold)) told(std::move(one));
    while (!left_.empty() && hand_off_.asks.push(std::move(left_.front()))) left_.pop_front();
    end_observing(now_ns());
    counts_.socket = socket_->counts();
    counts_.clients = clients_.size();
    const std::lock_guard lock(mutex_);
    told_counts_ = counts_;
  }
}

void Server::Network::hear(const net::ClientMessage& message) {
  ++counts_.requests;
  Client& client = clients_[message.client];
  if (client.name.empty())
    client.name = message.name.empty() ? std::string(kUnnamed) : std::string(message.name);
  std::optional<std::uint64_t> id;
  auto request = parse_request(message.frames, id);
  if (!request.ok()) return refuse(message.client, id, request.error().message);
  if (!client.greeted && request->op != Op::kHello)
    return refuse(message.client, id,
                  found_accepted(name_of(request->op), "hello first, with the protocol's number"),
                  Known::kNo);
  if (of_simulation(request->op))
    hand_over(message.client, client, std::move(*request));
  else
    answer_here(message.client, client, *request);
}

void Server::Network::gone(ClientId client) {
  if (clients_.erase(client) > 0)
    left_.push_back({.sort = Ask::Sort::kGone, .client = client, .name = {}, .request = {}});
}

void Server::Network::refuse(ClientId id, std::optional<std::uint64_t> request,
                             const std::string& line, Known known) {
  ++counts_.refused;
  if (request == 0u) return;
  json map{{"id", request.value_or(0)}, {"ok", false}, {"error", line}};
  if (known == Known::kNo) map["unknown"] = true;
  transmit(id, map, {{{}}});
}

void Server::Network::greet(ClientId id, Client& client, const Request& request) {
  const auto taken = [&](const auto& other) {
    return other.first != id && other.second.participant == request.agent;
  };
  if (!request.agent.empty() && std::ranges::any_of(clients_, taken))
    return refuse(
        id, request.id,
        fmt::format("hello: participant: found '{}', whom another client is; accepted: one "
                    "that nobody is",
                    request.agent));
  if (!request.agent.empty()) client.participant = request.agent;
  // A key's name is its client's; without keys the client says how it is called.
  if (client.name == kUnnamed && !request.name.empty()) client.name = request.name;
  client.greeted = true;
  json map = described_;
  map["id"] = request.id;
  map["ok"] = true;
  map["name"] = client.name;
  map["step"] = step_;
  map["time_ns"] = time_ns_;
  if (ring_) map["shared_memory"] = ring_->path();
  send(id, map, {{{}}});
}

void Server::Network::answer_here(ClientId id, Client& client, const Request& request) {
  json map{{"id", request.id}, {"ok", true}};
  switch (request.op) {
    case Op::kHello:
      return greet(id, client, request);
    case Op::kTime:
      map["sent_ns"] = request.sent_ns;
      map["server_ns"] = now_ns();
      map["time_ns"] = time_ns_;
      break;
    case Op::kShared:
      if (!ring_ || request.token != ring_->token())
        return refuse(id, request.id, "shared: token: found another; accepted: the memory's own");
      client.mail.shared = true;
      break;
    case Op::kCounts: {
      const auto& socket = counts_.socket;
      map["counts"] = {{"clients", clients_.size()},
                       {"requests", counts_.requests},
                       {"refused", counts_.refused},
                       {"busy", counts_.busy},
                       {"lost_messages", socket.lost},
                       {"too_fast", socket.too_fast},
                       {"too_many", socket.too_many},
                       {"unknown_keys", socket.not_known},
                       {"failed_handshakes", socket.no_greeting},
                       {"crowded_out", socket.connections.crowded_out},
                       {"endless", socket.connections.endless},
                       {"dropped_readings", dropped_}};
      break;
    }
    case Op::kObserve:
      if (client.mail.observe)
        return refuse(id, request.id, "observe: found a second one; accepted: one at a time");
      if (request.wait_s > 0.0 && !client.mail.any(newest_)) {
        client.mail.observe = {request.id, now_ns() + static_cast<TimeNs>(request.wait_s * 1e9)};
        return;
      }
      return deliver(id, client, std::move(map), {{{}}}, true);
    default:
      break;
  }
  send(id, map, {{{}}});
}

void Server::Network::hand_over(ClientId id, Client& client, Request request) {
  const std::uint64_t number = request.id;
  const Op op = request.op;
  if (client.mail.asked >= kAsked ||
      !hand_off_.asks.push({Ask::Sort::kRequest, id, client.name, std::move(request)})) {
    ++counts_.busy;
    return refuse(id, number,
                  fmt::format("{}: found {} requests that wait; accepted: up to {} of a client",
                              name_of(op), client.mail.asked, kAsked));
  }
  ++client.mail.asked;
}

void Server::Network::told(Told told) {
  if (told.news) put_news(*told.news);
  if (told.answer) answer(*told.answer);
}

void Server::Network::put_news(News& news) {
  step_ = news.step;
  time_ns_ = news.time_ns;
  clock_ = news.clock;
  dropped_ = news.dropped;
  for (const Reading& reading : news.newest) newest_.put(reading);
  for (const Reading& reading : news.arrived)
    for (auto& [id, client] : clients_)
      if (client.mail.kept.contains(reading.stream)) client.mail.put(reading);
  for (const auto& image : news.images) {
    std::optional<std::uint64_t> position;
    bool tried = false;
    for (auto& [id, client] : clients_) {
      if (!client.mail.images.contains(image->stream)) continue;
      if (client.mail.shared && !std::exchange(tried, true)) position = ring_->put(image->bytes());
      client.mail.put(*image, client.mail.shared ? position : std::nullopt);
    }
  }
}

void Server::Network::answer(const Answer& answer) {
  const auto at = clients_.find(answer.client);
  if (at == clients_.end()) return;  // it left
  Client& client = at->second;
  --client.mail.asked;
  if (!answer.ok) return refuse(answer.client, answer.id, answer.error);
  json map{{"id", answer.id}, {"ok", true}};
  Outgoing message{{{}}};
  map["step"] = answer.step;
  map["time_s"] = answer.time_s;
  bool mail = false;
  switch (answer.op) {
    case Op::kTick:
    case Op::kWait:
    case Op::kRestore:
      map["hash"] = answer.hash;
      mail = true;
      break;
    case Op::kTruth:
      map["values"] = answer.values;
      if (!answer.joints.empty()) map["joints"] = answer.joints;
      break;
    case Op::kPoses: {
      const auto put = [&](const std::vector<double>& values) {
        const auto* bytes = reinterpret_cast<const std::byte*>(values.data());
        message.frames.emplace_back(bytes, bytes + values.size() * sizeof(double));
      };
      put(answer.values);
      map["poses"] = {{"rows", facts_.agents.size()}, {"columns", 13}, {"frame", 1}};
      if (answer.joints.empty()) break;
      put(answer.joints);
      map["joints"] = {{"rows", answer.with_joints.size()},
                       {"columns", answer.joints.size() / answer.with_joints.size()},
                       {"frame", 2},
                       {"agents", answer.with_joints}};
      break;
    }
    case Op::kInstruments: {
      map["time_s"] = answer.instruments->time_s;
      json& numbers = map["numbers"] = json::object();
      for (const auto& [name, value] : answer.instruments->numbers) numbers[name] = value;
      map["streams"] = answer.instruments->streams;
      map["message"] = answer.instruments->message;
      map["message_from"] = answer.instruments->message_from;
      break;
    }
    case Op::kSources: {
      json& sources = map["sources"] = json::array();
      for (const SourceInfo& source : answer.sources) sources.push_back(described(source));
      break;
    }
    case Op::kSave:
      message.frames.push_back(answer.bytes);
      map["state"] = {{"frame", 1}};
      break;
    case Op::kRecord:
      map["file"] = answer.text;
      break;
    case Op::kKeep: {
      const auto stream = static_cast<std::uint32_t>(answer.values.at(0));
      if (answer.values.at(1) > 0.0)
        client.mail.kept.insert(stream);
      else
        client.mail.kept.erase(stream);
      break;
    }
    case Op::kImage: {
      const auto stream = static_cast<std::uint32_t>(answer.values.at(0));
      if (answer.values.at(1) > 0.0)
        client.mail.images[stream] = answer.values.at(2) > 0.0;
      else
        client.mail.images.erase(stream);
      break;
    }
    default:
      break;
  }
  deliver(answer.client, client, std::move(map), std::move(message), mail);
}

void Server::Network::end_observing(TimeNs now) {
  for (auto& [id, client] : clients_) {
    if (!client.mail.observe) continue;
    if (!client.mail.any(newest_) && now < client.mail.observe->until_ns) continue;
    const std::uint64_t request = client.mail.observe->id;
    client.mail.observe.reset();
    deliver(id, client, {{"id", request}, {"ok", true}}, {{{}}}, true);
  }
}

void Server::Network::deliver(ClientId id, Client& client, json map, Outgoing message, bool mail) {
  if (map.at("id") == 0) return;  // it wants no answer, and keeps its mail
  if (mail) {
    map["time_ns"] = time_ns_;
    map["clock"] = clock_;
    if (!map.contains("step")) map["step"] = step_;
    client.mail.take(newest_, map, message);
  }
  send(id, map, std::move(message));
}

// Unless it is for a request that wants no answer.
void Server::Network::send(ClientId id, const json& map, Outgoing message) {
  if (map.at("id") != 0) transmit(id, map, std::move(message));
}

// The first of the message's frames is the map's place.
void Server::Network::transmit(ClientId id, const json& map, Outgoing message) {
  message.frames.front() = net::pack(map);
  std::vector<net::Bytes> frames(message.frames.begin(), message.frames.end());
  (void)socket_->send(id, frames);  // one that is lost is counted
}

Server::Server(std::unique_ptr<Network> network) : network_(std::move(network)) {}
Server::~Server() = default;

Result<std::unique_ptr<Server>> Server::start(ServedFacts facts, HandOff& hand_off,
                                              const ServerOptions& options) {
  NERITIC_TRY(auto socket, net::ServerSocket::bind(options.socket));
  std::unique_ptr<net::ArrayRing> ring;
  if (options.shared_memory) {
    // Where there is none arrays go as frames.
    if (auto made = net::ArrayRing::create(); made.ok()) ring = std::move(*made);
  }
  return std::unique_ptr<Server>(new Server(
      std::make_unique<Network>(std::move(facts), hand_off, std::move(socket), std::move(ring))));
}

Address Server::address() const {
  return network_->address();
}
Server::Counts Server::counts() const {
  return network_->counts();
}

}  // namespace neritic::testbed
