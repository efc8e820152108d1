// The simulation's side of a server: turns the world as the clients ask, and tells what is new.
// With a client that holds the clock the world stands still until that one ticks; in real time it
// goes on by itself and a tick is a wait. The thread that owns the world.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>

#include "testbed/server/hand_off.hpp"

namespace neritic::testbed {

struct WorldServerOptions {
  bool real_time = false;            // the world was opened so too
  std::filesystem::path recordings;  // where clients' recordings go; empty: they make none
  std::uint64_t last_step = 0;       // ends there; 0: with stop
};

ServedFacts facts_of(const World& world, bool real_time, const std::string& version);

class WorldServer {
 public:
  // Borrows both.
  WorldServer(World& world, HandOff& hand_off, const WorldServerOptions& options)
      : world_(world), hand_off_(hand_off), options_(options), published_(world.streams().size()) {}

  // Until stop, which is asked before each step, or an Error of the world in real time.
  Status run(const std::function<bool()>& stop);
  // Instead of run(), for a world that goes on by itself (World::attach), in real time: answers
  // what was asked since the last turn and tells what is new.
  void turn();

 private:
  struct Turn {  // a tick that goes on
    ClientId client = 0;
    std::uint64_t id = 0, until = 0;
    std::size_t arrived = 0;  // readings since it began
  };
  struct Waiting {
    ClientId client = 0;
    std::uint64_t id = 0, until = 0;
    TimeNs give_up_ns = 0;
  };
  struct Wish {
    double rate_hz = 0.0;
    bool keep = false;
  };

  bool take_requests();
  Status step();
  void handle(Ask& ask);
  void gone(ClientId client);
  Status act(const Ask& ask, Answer& answer);
  Status begin_tick(const Ask& ask);
  Status hold_clock(const Ask& ask);
  Status keep(const Ask& ask, Answer& answer);
  Status image(const Ask& ask, Answer& answer);
  Status wish_images(std::uint32_t stream);
  Status inject(const Ask& ask);
  Status record(const Ask& ask, Answer& answer);
  void truth_of(std::uint32_t agent, Answer& answer);
  Status check_holder(const Ask& ask) const;
  void finish_waiting(const Status& status);
  enum class Wake { kNow, kLater };  // the network's thread
  void publish(Wake wake = Wake::kNow);
  void tell(Answer answer);

  World& world_;
  HandOff& hand_off_;
  const WorldServerOptions options_;
  std::optional<Turn> turn_;
  std::vector<Waiting> waiting_;
  std::deque<Ask> held_;  // of the client whose tick goes on: they come after it
  ClientId holder_ = 0;
  std::string holder_name_;
  std::map<std::uint32_t, std::set<ClientId>> keepers_;
  std::map<std::uint32_t, std::map<ClientId, Wish>> wishes_;
  std::set<std::string> sources_;   // that clients have sent under
  std::vector<Reading> published_;  // by stream
  std::unique_ptr<News> news_;      // that found the queue full
};

}  // namespace neritic::testbed
