#include "testbed/server/world_server.hpp"

#include <algorithm>
#include <utility>

#include "engine/core/refusal.hpp"
#include "testbed/server/client_mail.hpp"

namespace neritic::testbed {
namespace {

constexpr std::size_t kRequestsAtOnce = 64;  // between two steps
// Between two looks at the requests: steps, and readings that someone wants each of.
constexpr std::uint64_t kStepsAtOnce = 24, kReadingsAtOnce = 1024;
// A tick ends early at so many: its client has to take them before more come. Then none is lost.
constexpr std::size_t kReadingsOfTick = ClientMail::kMostKept / 2;
constexpr std::chrono::milliseconds kIdle{50};  // that it waits for requests at most
// For the inbox's numbers of sources; the rest is left to the scene's devices.
constexpr std::size_t kMostSources = 128;
// Readings and images that wait while the network's thread is behind.
constexpr std::size_t kMostArrived = 1 << 15, kMostImages = 16;

bool is_word(const std::string& name) {
  return name.size() <= 64 && name.front() != '.' && name.front() != '-' &&
         std::ranges::all_of(name, [](char c) {
           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                  c == '_' || c == '-' || c == '.';
         });
}

bool same(const Reading& a, const Reading& b) {
  return a.count == b.count && a.sequence == b.sequence && a.stamp_ns == b.stamp_ns &&
         a.arrival_ns == b.arrival_ns;
}

}  // namespace

ServedFacts facts_of(const World& world, bool real_time, const std::string& version) {
  return {.title = world.title(),
          .path = world.path(),
          .version = version,
          .seed = world.seed(),
          .step_s = world.step_s(),
          .real_time = real_time,
          .agents = world.agents(),
          .streams = world.streams(),
          .objects = world.objects()};
}

void WorldServer::turn() {
  (void)take_requests();
  publish();
  finish_waiting({});
}

Status WorldServer::run(const std::function<bool()>& stop) {
  publish();
  while (!stop()) {
    if (options_.last_step > 0 && world_.step() >= options_.last_step) break;
    const bool asked = take_requests();
    if (turn_ || options_.real_time)
      NERITIC_TRY_STATUS(step());
    else if (asked || news_)
      publish();
    finish_waiting({});
  }
  return {};
}

// Requests that came; without a turn it waits for them a little.
bool WorldServer::take_requests() {
  const bool busy = turn_ || options_.real_time;
  auto asks = hand_off_.asks.take(kRequestsAtOnce, busy ? std::chrono::milliseconds(0) : kIdle);
  for (Ask& ask : asks) handle(ask);
  while (!turn_ && !held_.empty()) {
    Ask ask = std::move(held_.front());
    held_.pop_front();
    handle(ask);
  }
  return !asks.empty();
}

Status WorldServer::step() {
  const std::uint64_t steps =
      options_.real_time ? 1 : std::min(kStepsAtOnce, turn_->until - world_.step());
  const Status status =
      world_.tick(steps, [&] { return world_.arrived() >= std::size_t{kReadingsAtOnce}; });
  if (turn_) turn_->arrived += world_.arrived();
  const bool ends = !options_.real_time && (!status.ok() || world_.step() >= turn_->until ||
                                            turn_->arrived >= kReadingsOfTick);
  // Where the tick's answer follows, that wakes the network's thread, once for both.
  publish(ends && turn_->client != 0 ? Wake::kLater : Wake::kNow);
  if (options_.real_time) return status;
  if (!ends) return {};
  const Turn turn = *std::exchange(turn_, std::nullopt);
  if (turn.client == 0) return {};  // it left
  Answer answer{.client = turn.client, .id = turn.id, .op = Op::kTick, .ok = status.ok()};
  if (!status.ok()) answer.error = status.error().message;
  tell(std::move(answer));
  return {};
}

void WorldServer::tell(Answer answer) {
  answer.step = world_.step();
  answer.time_s = world_.time_s();
  answer.hash = world_.hash();
  hand_off_.tell(std::move(answer));
}

void WorldServer::handle(Ask& ask) {
  if (ask.sort == Ask::Sort::kGone) return gone(ask.client);
  if (turn_ && turn_->client == ask.client) {
    held_.push_back(std::move(ask));  // bounded by kAsked
    return;
  }
  Answer answer{.client = ask.client, .id = ask.request.id, .op = ask.request.op};
  const Status status = act(ask, answer);
  const bool later = ask.request.op == Op::kTick || ask.request.op == Op::kWait;
  if (status.ok() && later) return;
  answer.ok = status.ok();
  if (!status.ok()) answer.error = status.error().message;
  tell(std::move(answer));
}

void WorldServer::gone(ClientId client) {
  if (holder_ == client) {
    holder_ = 0;
    holder_name_.clear();
  }
  // Its tick ends with the steps that are being taken.
  if (turn_ && turn_->client == client) turn_.reset();
  std::erase_if(waiting_, [&](const Waiting& one) { return one.client == client; });
  std::erase_if(held_, [&](const Ask& one) { return one.client == client; });
  for (auto& [stream, clients] : keepers_)
    if (clients.erase(client) > 0 && clients.empty()) (void)world_.keep(stream, false);
  for (auto& [stream, clients] : wishes_)
    if (clients.erase(client) > 0) (void)wish_images(stream);
}

Status WorldServer::check_holder(const Ask& ask) const {
  if (options_.real_time || holder_ == ask.client) return {};
  return refusal(name_of(ask.request.op),
                 holder_ == 0 ? "a clock that nobody holds"
                 : holder_name_ == ask.name
                     ? fmt::format("a clock that another client of the name {} holds", ask.name)
                     : fmt::format("a clock that {} holds", holder_name_),
                 "the client that holds the clock");
}

Status WorldServer::hold_clock(const Ask& ask) {
  if (options_.real_time)
    return refusal("clock", "a server in real time, where nobody holds it",
                   "a server in lock-step (neritic serve --lockstep)");
  if (!ask.request.on) {
    if (holder_ != ask.client) return {};
    holder_ = 0;
    holder_name_.clear();
    return {};
  }
  if (holder_ != 0) return check_holder(ask);
  holder_ = ask.client;
  holder_name_ = ask.name;
  return {};
}

// The first to tick takes the clock.
Status WorldServer::begin_tick(const Ask& ask) {
  if (options_.real_time) {
    waiting_.push_back({ask.client, ask.request.id, world_.step() + ask.request.steps,
                        now_ns() + static_cast<TimeNs>(3600e9)});
    return {};
  }
  if (holder_ == 0) {
    holder_ = ask.client;
    holder_name_ = ask.name;
  }
  NERITIC_TRY_STATUS(check_holder(ask));
  turn_ = Turn{ask.client, ask.request.id, world_.step() + ask.request.steps, 0};
  return {};
}

Status WorldServer::keep(const Ask& ask, Answer& answer) {
  NERITIC_TRY(const std::uint32_t stream, world_.stream(ask.request.stream));
  auto& clients = keepers_[stream];
  const bool before = !clients.empty();
  if (ask.request.on)
    clients.insert(ask.client);
  else
    clients.erase(ask.client);
  answer.values = {static_cast<double>(stream), ask.request.on ? 1.0 : 0.0};
  if (before == !clients.empty()) return {};
  const Status status = world_.keep(stream, !clients.empty());
  if (!status.ok()) clients.erase(ask.client);
  return status;
}

Status WorldServer::wish_images(std::uint32_t stream) {
  const auto& clients = wishes_[stream];
  if (clients.empty()) return world_.drop_image(stream);
  // All get the images of the one that wants most; 0 is the sensor's own rate.
  Wish all = clients.begin()->second;
  for (const auto& [client, wish] : clients) {
    all.rate_hz =
        all.rate_hz == 0.0 || wish.rate_hz == 0.0 ? 0.0 : std::max(all.rate_hz, wish.rate_hz);
    all.keep = all.keep || wish.keep;
  }
  return world_.want_image(stream, all.rate_hz, all.keep);
}

Status WorldServer::image(const Ask& ask, Answer& answer) {
  NERITIC_TRY(const std::uint32_t stream, world_.stream(ask.request.stream));
  // Another's wish would hide a rate that is refused.
  if (ask.request.on) NERITIC_TRY_STATUS(world_.check_image(stream, ask.request.rate_hz));
  auto& clients = wishes_[stream];
  if (ask.request.on)
    clients[ask.client] = {ask.request.rate_hz, ask.request.keep};
  else if (clients.erase(ask.client) == 0)
    return {};
  answer.values = {static_cast<double>(stream), ask.request.on ? 1.0 : 0.0,
                   ask.request.keep ? 1.0 : 0.0};
  const Status status = wish_images(stream);
  if (!status.ok()) clients.erase(ask.client);
  return status;
}

Status WorldServer::inject(const Ask& ask) {
  const std::string& source = ask.request.source.empty() ? ask.name : ask.request.source;
  if (!sources_.contains(source)) {
    if (sources_.size() >= kMostSources)
      return refusal("inject: source", fmt::format("a new one beside {}", sources_.size()),
                     fmt::format("up to {} of all clients", kMostSources));
    sources_.insert(source);
  }
  return world_.inject(ask.request.stream, ask.request.values, source, ask.request.stamp_s);
}

Status WorldServer::record(const Ask& ask, Answer& answer) {
  if (options_.recordings.empty())
    return refusal("record", "a server that keeps no recordings", "neritic serve --recordings DIR");
  if (!is_word(ask.request.name))
    return refusal("record: name", fmt::format("'{}'", ask.request.name),
                   "a plain word, without folders");
  const auto file = options_.recordings / ask.request.name;
  answer.text = file.string();
  return world_.record(file);
}

void WorldServer::truth_of(std::uint32_t agent, Answer& answer) {
  std::vector<double>& values = answer.values;
  const auto truth = world_.truth(world_.agents()[agent].name);
  if (!truth.ok()) {
    values.insert(values.end(), 13, 0.0);
    return;
  }
  const auto add = [&](const auto& numbers) {
    values.insert(values.end(), numbers.begin(), numbers.end());
  };
  add(truth->position), add(truth->orientation);
  add(truth->linear_velocity), add(truth->angular_velocity);
  if (truth->joints.empty()) return;
  answer.joints.insert(answer.joints.end(), truth->joints.begin(), truth->joints.end());
  answer.with_joints.push_back(agent);
}

Status WorldServer::act(const Ask& ask, Answer& answer) {
  const Request& request = ask.request;
  switch (request.op) {
    case Op::kTick:
      return begin_tick(ask);
    case Op::kWait:
      waiting_.push_back({ask.client, request.id, world_.step() + request.steps,
                          now_ns() + static_cast<TimeNs>(request.wait_s * 1e9)});
      return {};
    case Op::kClock:
      return hold_clock(ask);
    case Op::kKeep:
      return keep(ask, answer);
    case Op::kImage:
      return image(ask, answer);
    case Op::kLink: {
      NERITIC_TRY_STATUS(check_holder(ask));
      NERITIC_TRY(const std::uint32_t stream, world_.stream(request.stream));
      return world_.set_link(stream, request.link);
    }
    case Op::kCommand:
      return world_.command(request.agent, request.kind, request.values, request.hold_s, ask.name);
    case Op::kRelease:
      return world_.release(request.agent, ask.name);
    case Op::kInject:
      return inject(ask);
    case Op::kSources:
      answer.sources = world_.sources();
      return {};
    case Op::kTruth: {
      NERITIC_TRY(const std::size_t agent, world_.agent(request.agent));
      truth_of(static_cast<std::uint32_t>(agent), answer);
      NERITIC_TRY(const Truth truth, world_.truth(request.agent));
      answer.values.insert(answer.values.end(), truth.current.begin(), truth.current.end());
      answer.values.push_back(static_cast<double>(truth.touched_steps));
      answer.values.insert(answer.values.end(), truth.thruster_n.begin(), truth.thruster_n.end());
      return {};
    }
    case Op::kPoses:
      for (std::uint32_t i = 0; i < world_.agents().size(); ++i) truth_of(i, answer);
      return {};
    case Op::kInstruments: {
      NERITIC_TRY(Instruments instruments, world_.instruments(request.agent));
      answer.instruments = std::make_unique<Instruments>(std::move(instruments));
      return {};
    }
    case Op::kSave:
      answer.bytes = world_.save();
      return {};
    case Op::kRestore: {
      if (options_.real_time)
        return refusal("restore", "a server in real time", "one in lock-step");
      NERITIC_TRY_STATUS(check_holder(ask));
      const Status status = world_.restore(request.bytes);
      publish();
      return status;
    }
    case Op::kRecord:
      return record(ask, answer);
    case Op::kStopRecording:
      return world_.stop_recording();
    default:
      return failure(ErrorCode::kInternal, "{} is not the simulation's", name_of(request.op));
  }
}

void WorldServer::finish_waiting(const Status& status) {
  if (waiting_.empty()) return;
  const TimeNs now = now_ns();
  std::erase_if(waiting_, [&](const Waiting& one) {
    const bool late = now >= one.give_up_ns;
    if (world_.step() < one.until && !late) return false;
    (void)status;
    tell({.client = one.client, .id = one.id, .op = Op::kWait});
    return true;
  });
}

// Sends what changed since the last time; if the queue is full, with the next.
void WorldServer::publish(Wake wake) {
  if (!news_) news_ = std::make_unique<News>();
  News& news = *news_;
  news.step = world_.step();
  news.time_ns = world_.time_ns();
  news.clock = holder_name_;
  news.dropped = world_.dropped();
  const auto newest = world_.newest();
  news.newest.clear();
  for (std::size_t i = 0; i < newest.size(); ++i)
    if (!same(newest[i], published_[i])) news.newest.push_back(newest[i]);
  for (Reading& reading : world_.take_arrived()) news.arrived.push_back(reading);
  if (news.arrived.size() > kMostArrived)
    news.arrived.erase(news.arrived.begin(), news.arrived.end() - kMostArrived);
  for (auto& image : world_.take_images()) news.images.push_back(std::move(image));
  if (news.images.size() > kMostImages)
    news.images.erase(news.images.begin(), news.images.end() - kMostImages);
  Told told{nullptr, std::move(news_)};
  if (!hand_off_.told.push(std::move(told))) {
    news_ = std::move(told.news);
    return;
  }
  std::copy(newest.begin(), newest.end(), published_.begin());
  if (wake == Wake::kNow) hand_off_.wake_network();
}

}  // namespace neritic::testbed
