#include "testbed/server/remote_instruments.hpp"

#include <condition_variable>
#include <mutex>
#include <thread>

#include "engine/core/clock.hpp"
#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"
#include "testbed/instruments/instrument_numbers.hpp"
#include "testbed/server/remote_reply.hpp"

namespace neritic::testbed {
namespace remote_instruments {

struct Heard {
  hud::DiveData data;
  std::vector<hud::StreamHealth> streams;
};

}  // namespace remote_instruments

namespace {

using remote_instruments::Heard;

using nlohmann::json;

constexpr std::size_t kMostStreams = 64;

std::string text_in(const json& map, const char* key) {
  const auto at = map.find(key);
  return at != map.end() && at->is_string() ? printable(at->get_ref<const std::string&>(), 64)
                                            : std::string();
}

hud::Health health_named(const std::string& name) {
  return name == "good"      ? hud::Health::kGood
         : name == "waiting" ? hud::Health::kWaiting
                             : hud::Health::kLost;
}

// The answer to "instruments", as a stranger's: names that are not known are left out, since a
// newer server may have more.
Result<Heard> heard_of(const json& map, const std::string& where) {
  Heard news;
  const auto time = map.find("time_s"), numbers = map.find("numbers");
  if (time == map.end() || !time->is_number() || !std::isfinite(time->get<double>()) ||
      std::abs(time->get<double>()) > 1e9 || numbers == map.end() || !numbers->is_object())
    return refusal(where, "an answer without instruments", "a Neritic server's");
  news.data.time_s = time->get<double>();
  for (const auto& [name, value] : numbers->items())
    if (value.is_number()) (void)set_number(news.data, name, value.get<double>());
  news.data.gas_known = news.data.gas_known && diver::is_mix(news.data.gas);
  news.data.message = std::string_view(text_in(map, "message"));
  news.data.message_from = std::string_view(text_in(map, "message_from"));
  const auto streams = map.find("streams");
  if (streams == map.end() || !streams->is_array()) return news;
  for (const json& stream : *streams) {
    const auto text = [](const json& one) { return one.is_string(); };
    if (news.streams.size() == kMostStreams) break;
    if (!stream.is_array() || stream.size() != 3 || !std::ranges::all_of(stream, text)) continue;
    news.streams.push_back({std::string_view(printable(stream[0].get<std::string>())),
                            std::string_view(printable(stream[1].get<std::string>())),
                            health_named(stream[2].get<std::string>())});
  }
  return news;
}

// The diver that is asked for, in the server's list of agents.
Result<std::string> diver_of(const json& hello, const std::string& where,
                             const std::string& asked) {
  std::vector<std::string> divers;
  for (const json& agent : hello.at("agents")) {
    if (!agent.is_object() || text_in(agent, "kind") != "diver") continue;
    divers.push_back(text_in(agent, "name"));
  }
  if (divers.empty())
    return refusal(where, "a dive without divers who swim",
                   "a scene with a diver that has physics");
  if (asked.empty()) return divers.front();
  if (std::ranges::find(divers, asked) != divers.end()) return asked;
  return refusal("--diver", fmt::format("'{}'", asked), fmt::format("{}", fmt::join(divers, ", ")));
}

}  // namespace

class RemoteInstruments::Thread {
 public:
  Thread(RemoteInstrumentsOptions options, std::unique_ptr<Remote> remote, std::string diver,
         std::string title)
      : diver_(std::move(diver)),
        title_(std::move(title)),
        options_(std::move(options)),
        where_(to_text(options_.remote.socket.address)),
        remote_(std::move(remote)),
        heard_ns_(now_ns()),
        thread_([this] { run(); }) {}
  ~Thread() {
    {
      const std::lock_guard lock(mutex_);
      stop_ = true;
    }
    wake_.notify_all();
    thread_.join();
  }

  double silent_s() const {
    const std::lock_guard lock(mutex_);
    return 1e-9 * static_cast<double>(now_ns() - heard_ns_);
  }
  bool lost() const { return silent_s() > options_.lost_after_s; }
  std::uint64_t connections() const {
    const std::lock_guard lock(mutex_);
    return connections_;
  }
  double time_s() const {
    const double silent = silent_s();
    const std::lock_guard lock(mutex_);
    return heard_.data.time_s + (silent > options_.lost_after_s ? silent : 0.0);
  }
  InstrumentNews read() const {
    const double silent = silent_s();
    const std::lock_guard lock(mutex_);
    InstrumentNews out{heard_.data, heard_.streams, {}};
    if (silent > options_.lost_after_s) {
      out.data = hud::DiveData{.time_s = heard_.data.time_s + silent, .link_lost = true};
      out.streams.assign(1, {"connection", hud::FixedText::of("no answer for {:.0f} s", silent),
                             hud::Health::kLost});
    } else {
      out.streams.insert(out.streams.begin(),
                         {"connection", std::string_view(where_), hud::Health::kGood});
    }
    return out;
  }

  const std::string diver_, title_;

 private:
  // False: it is time to stop.
  bool pause(double seconds) {
    std::unique_lock lock(mutex_);
    wake_.wait_for(lock, std::chrono::duration<double>(seconds), [&] { return stop_; });
    return !stop_;
  }
  void run() {
    constexpr double kAgain_s = 0.3;
    do {
      if (!remote_ && !connect_again()) continue;
      if (!ask()) remote_.reset();
    } while (pause(remote_ ? 1.0 / options_.rate_hz : kAgain_s));
  }
  bool connect_again() {
    RemoteOptions again = options_.remote;
    again.patience_s = std::min(again.patience_s, 1.0);
    auto remote = Remote::connect(again);
    if (!remote.ok()) return false;
    remote_ = std::move(*remote);
    const std::lock_guard lock(mutex_);
    ++connections_;
    return true;
  }
  bool ask() {
    const auto reply = remote_->call({{"op", "instruments"}, {"agent", diver_}});
    if (!reply.ok()) return false;
    auto news = heard_of(reply->map, where_);
    if (!news.ok()) return false;
    const std::lock_guard lock(mutex_);
    heard_ = std::move(*news);
    heard_ns_ = now_ns();
    return true;
  }

  const RemoteInstrumentsOptions options_;
  const std::string where_;
  std::unique_ptr<Remote> remote_;  // the thread's; absent: there is no connection
  mutable std::mutex mutex_;        // of what follows
  std::condition_variable wake_;
  bool stop_ = false;
  Heard heard_;
  TimeNs heard_ns_ = 0;
  std::uint64_t connections_ = 1;
  std::thread thread_;  // the last, as it uses the others
};

RemoteInstruments::RemoteInstruments(std::unique_ptr<Thread> thread) : thread_(std::move(thread)) {}
RemoteInstruments::~RemoteInstruments() = default;

Result<std::unique_ptr<RemoteInstruments>> RemoteInstruments::connect(
    const RemoteInstrumentsOptions& options) {
  const std::string where = to_text(options.remote.socket.address);
  NERITIC_TRY(auto remote, Remote::connect(options.remote));
  NERITIC_TRY(std::string diver, diver_of(remote->hello(), where, options.diver));
  std::string title = text_in(remote->hello(), "title");
  RemoteInstrumentsOptions later = options;
  later.remote.patience_s = std::min(options.remote.patience_s, options.lost_after_s);
  return std::unique_ptr<RemoteInstruments>(new RemoteInstruments(std::make_unique<Thread>(
      std::move(later), std::move(remote), std::move(diver), std::move(title))));
}

const std::string& RemoteInstruments::diver() const {
  return thread_->diver_;
}
const std::string& RemoteInstruments::title() const {
  return thread_->title_;
}
double RemoteInstruments::time_s() const {
  return thread_->time_s();
}
InstrumentNews RemoteInstruments::read() {
  return thread_->read();
}
bool RemoteInstruments::lost() const {
  return thread_->lost();
}
std::uint64_t RemoteInstruments::connections() const {
  return thread_->connections();
}

}  // namespace neritic::testbed
