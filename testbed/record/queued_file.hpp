// A file that grows while a run goes on (engine/core/growing_file.hpp): the stepping thread hands
// batches over, and a thread of its own makes the text and waits for the disk. The memory is
// bounded: add() waits while too much is not written.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

#include "engine/core/growing_file.hpp"

namespace neritic::testbed {

inline void append(std::string& to, const std::string& more) {
  to += more;
}
inline std::size_t bytes_of(const std::string& bytes) {
  return bytes.size();
}

// Batch: a string, or what has empty() and those two functions beside it.
template <class Batch>
class QueuedFile {
 public:
  static constexpr std::size_t kMostWaiting_bytes = std::size_t{16} << 20;

  // text: the lines of a batch, on the writer's thread. head, of whole lines, comes first and is
  // written at once: a disk that fills leaves it.
  QueuedFile(std::filesystem::path path, std::string_view head,
             std::function<std::string(const Batch&)> text)
      : text_(std::move(text)), file_(std::move(path)), status_(file_.claim()) {
    if (status_.ok()) status_ = file_.append_lines(head);
    if (status_.ok()) status_ = file_.flush();
    writer_ = std::thread([this] { write_all(); });
  }
  ~QueuedFile() { stop(); }

  // An Error: what the writer met.
  Status add(const Batch& more) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return !status_.ok() || bytes_of(waiting_) < kMostWaiting_bytes; });
    if (!status_.ok()) return status_;
    append(waiting_, more);
    changed_.notify_all();
    return {};
  }
  // After the last batch: writes all and gives the file its name, unless add() failed.
  Status finish() {
    stop();
    return status_.ok() ? file_.finish() : status_;
  }

 private:
  void write_all() {
    std::unique_lock lock(mutex_);
    while (true) {
      changed_.wait(lock, [&] { return stop_ || !waiting_.empty(); });
      if (waiting_.empty()) return;
      const Batch batch = std::exchange(waiting_, {});
      changed_.notify_all();
      lock.unlock();
      const Status written = file_.append_lines(text_(batch));
      lock.lock();
      if (written.ok()) continue;
      status_ = written;
      changed_.notify_all();
      return;
    }
  }
  void stop() {
    if (!writer_.joinable()) return;
    {
      const std::lock_guard lock(mutex_);
      stop_ = true;
    }
    changed_.notify_all();
    writer_.join();
  }

  std::function<std::string(const Batch&)> text_;
  GrowingFile file_;  // the writer's; the owner's before and after it
  std::mutex mutex_;  // guards the next three
  Batch waiting_;
  Status status_;
  bool stop_ = false;
  std::condition_variable changed_;
  std::thread writer_;  // last: uses the others
};

}  // namespace neritic::testbed
