// Hand-offs between the network's thread and the simulation's: requests one way, answers and what
// was measured the other. Both ways over bounded queues; nothing else is shared. Plain values that
// one thread at a time owns.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "testbed/server/bounded_queue.hpp"
#include "testbed/server/request.hpp"
#include "testbed/world/world.hpp"

namespace neritic::testbed {

using ClientId = std::uint64_t;

// To the simulation.
struct Ask {
  enum class Sort { kRequest, kGone } sort = Sort::kRequest;  // kGone: the client left
  ClientId client = 0;
  std::string name;  // under which the client sends
  Request request;
};

// From the simulation: an answer, or what is new.
struct Answer {
  ClientId client = 0;
  std::uint64_t id = 0;
  Op op = Op::kTick;
  bool ok = true;
  std::string error;  // one line
  std::uint64_t step = 0, hash = 0;
  double time_s = 0.0;
  std::vector<double> values;                // of kTruth, kPoses
  std::vector<double> joints;                // likewise, of those that have limbs
  std::vector<std::uint32_t> with_joints;    // their agents
  std::vector<std::byte> bytes;              // of kSave
  std::string text;                          // of kRecord: the file
  std::unique_ptr<Instruments> instruments;  // of kInstruments
  std::vector<SourceInfo> sources;           // of kSources
};
struct News {
  std::uint64_t step = 0;
  std::int64_t time_ns = 0;
  std::string clock;                                // who holds it; empty: nobody
  std::vector<Reading> newest;                      // those that changed
  std::vector<Reading> arrived;                     // of streams that somebody keeps, each one
  std::vector<std::unique_ptr<WorldImage>> images;  // of streams that somebody wants
  std::uint64_t dropped = 0;                        // readings that were kept and lost so far
};
struct Told {
  std::unique_ptr<Answer> answer;
  std::unique_ptr<News> news;  // else
};

// How many may wait. A client has kAsked requests on their way at most, so that their answers are
// bounded too.
inline constexpr std::size_t kAsked = 64, kAsks = 4096, kTold = 512;

struct HandOff {
  BoundedQueue<Ask> asks{kAsks};
  BoundedQueue<Told> told{kTold};  // news; answers come beyond its bound, by that of their requests
  std::function<void()> wake_network;  // after something was told

  void tell(Answer answer) {
    told.push_always({std::make_unique<Answer>(std::move(answer)), nullptr});
    wake_network();
  }
};

// Facts that do not change while a world is served, for the network's thread.
struct ServedFacts {
  std::string title, path, version;
  std::uint64_t seed = 0;
  double step_s = 0.0;
  bool real_time = false;
  std::vector<AgentInfo> agents;
  std::vector<StreamInfo> streams;
  std::vector<std::string> objects;
};

}  // namespace neritic::testbed
