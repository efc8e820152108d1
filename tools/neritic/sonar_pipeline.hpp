// Many frames through three steps: read (workers), process (the calling thread, which owns the
// GPU), write (workers). Bounded: at most in_flight frames are between the first step and the last,
// and workers write before they read on. Frames finish in any order; each step gets the frame's
// number, so that no result depends on the order.
//
// Threads: `workers` of its own and the caller; steps must be callable from any worker at once,
// process only from the caller. All state is behind one mutex: a step takes milliseconds.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <new>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "engine/core/result.hpp"

namespace neritic::tools {

struct PipelineOptions {
  std::size_t frames = 0;
  std::size_t workers = 1;    // at least 1
  std::size_t in_flight = 3;  // frames in memory at once; at least 1
};

template <class Input, class Output>
class Pipeline {
 public:
  struct Steps {
    // Nothing: the frame is left out (the step has noted why). An error of any step ends the run.
    std::function<Result<std::optional<Input>>(std::size_t frame)> read;
    std::function<Result<Output>(std::size_t frame, Input input)> process;
    std::function<Status(std::size_t frame, Output output)> write;
    // After each frame that is written or left out, one call at a time, from any thread.
    std::function<void()> finished;
    // Once it says true it must go on doing so: no more frames are read, those under way go
    // through.
    std::function<bool()> stopped = [] { return false; };
  };

  Pipeline(PipelineOptions options, Steps steps) : options_(options), steps_(std::move(steps)) {}

  // Returns when every frame is through, at a stop or at the first error when what is under way is.
  Status run() {
    std::vector<std::jthread> workers;
    try {
      while (workers.size() < options_.workers) workers.emplace_back([this] { work(); });
    } catch (const std::system_error& error) {  // with fewer it takes longer
      if (workers.empty())
        return failure(ErrorCode::kOutOfMemory, "no thread can be started: {}", error.what());
    }
    process_all();
    workers.clear();  // joins
    return error_ ? Status(*error_) : Status();
  }

 private:
  using Lock = std::unique_lock<std::mutex>;

  bool ended() const {
    return error_.has_value() || finished_ == options_.frames ||
           (in_flight_ == 0 && steps_.stopped());
  }
  bool may_read() const {
    return next_ < options_.frames && in_flight_ < options_.in_flight && !error_ &&
           !steps_.stopped();
  }

  // A step's result; an exception that it throws (memory, a library) becomes an Error.
  template <class Step>
  static auto guarded(Step step) -> decltype(step()) {
    try {
      return step();
    } catch (const std::bad_alloc&) {
      return failure(ErrorCode::kOutOfMemory, "out of memory");
    } catch (const std::exception& error) {
      return failure(ErrorCode::kIo, "{}", error.what());
    }
  }

  void fail(const Error& error) {  // locked
    if (!error_) error_ = error;
    changed_.notify_all();
  }
  void finish() {  // locked
    --in_flight_;
    ++finished_;
    if (steps_.finished) steps_.finished();
    changed_.notify_all();
  }

  void work() {
    Lock lock(mutex_);
    while (true) {
      changed_.wait(lock, [this] { return ended() || !processed_.empty() || may_read(); });
      if (ended()) return;
      if (!processed_.empty())
        write_one(lock);
      else
        read_one(lock);
    }
  }

  void read_one(Lock& lock) {
    const std::size_t frame = next_++;
    ++in_flight_;
    lock.unlock();
    auto input = guarded([&] { return steps_.read(frame); });
    lock.lock();
    if (!input.ok()) return fail(input.error());
    if (!*input) return finish();
    read_.emplace_back(frame, std::move(**input));
    changed_.notify_all();
  }

  void write_one(Lock& lock) {
    auto [frame, output] = std::move(processed_.front());
    processed_.pop_front();
    lock.unlock();
    const Status written = guarded([&] { return steps_.write(frame, std::move(output)); });
    lock.lock();
    if (!written.ok()) return fail(written.error());
    finish();
  }

  void process_all() {
    Lock lock(mutex_);
    while (true) {
      changed_.wait(lock, [this] { return ended() || !read_.empty(); });
      if (ended()) return;
      auto [frame, input] = std::move(read_.front());
      read_.pop_front();
      lock.unlock();
      auto output = guarded([&] { return steps_.process(frame, std::move(input)); });
      lock.lock();
      if (!output.ok()) return fail(output.error());
      processed_.emplace_back(frame, std::move(*output));
      changed_.notify_all();
    }
  }

  const PipelineOptions options_;
  const Steps steps_;
  std::mutex mutex_;
  std::condition_variable changed_;
  // Guarded by mutex_.
  std::size_t next_ = 0, in_flight_ = 0, finished_ = 0;
  std::deque<std::pair<std::size_t, Input>> read_;
  std::deque<std::pair<std::size_t, Output>> processed_;
  std::optional<Error> error_;
};

}  // namespace neritic::tools
