// A pool that sleeps between jobs (workers.hpp).
#include "engine/sim/workers.hpp"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>
#include <vector>

namespace neritic::sim {
namespace {

// A thread claims this many tasks at once: vehicles cost microseconds each, so that the counter is
// seldom contended and the last claim of a crowd is short.
constexpr std::size_t kClaim = 4;

}  // namespace

struct Workers::Pool {
  std::mutex mutex;  // guards job, round, working, stop
  std::condition_variable begun, ended;
  Job job;
  std::uint64_t round = 0;
  std::size_t working = 0;  // threads that claimed the job and have not left it
  bool stop = false;
  std::atomic<std::size_t> next{0};  // the first task that nobody claimed
  std::vector<std::thread> threads;

  explicit Pool(unsigned count) {
    for (unsigned i = 1; i <= count; ++i) threads.emplace_back([this, i] { serve(i); });
  }
  ~Pool() {
    {
      const std::lock_guard lock(mutex);
      stop = true;
    }
    begun.notify_all();
    for (std::thread& thread : threads) thread.join();
  }

  void do_tasks(const Job& now, unsigned thread) {
    for (std::size_t from; (from = next.fetch_add(kClaim)) < now.count;)
      for (std::size_t i = from; i < std::min(from + kClaim, now.count); ++i)
        now.call(now.task, i, thread);
  }

  void serve(unsigned thread) {
    std::uint64_t seen = 0;
    std::unique_lock lock(mutex);
    while (true) {
      begun.wait(lock, [&] { return stop || round != seen; });
      if (stop) return;
      seen = round;
      if (next >= job.count) continue;  // woke after the others had claimed all of it
      ++working;
      const Job now = job;
      lock.unlock();
      do_tasks(now, thread);
      lock.lock();
      if (--working == 0) ended.notify_one();
    }
  }

  // The caller works too, and waits only for threads that are in the job: one that wakes late joins
  // nothing.
  void run(const Job& now) {
    {
      const std::lock_guard lock(mutex);
      job = now;
      next = 0;
      ++round;
    }
    begun.notify_all();
    do_tasks(now, 0);
    std::unique_lock lock(mutex);
    ended.wait(lock, [this] { return working == 0; });
  }
};

Workers::Workers(unsigned threads) {
  if (threads > 1) pool_ = std::make_unique<Pool>(threads - 1);
}
Workers::~Workers() = default;
Workers::Workers(const Workers& other) : Workers(other.threads()) {}
Workers::Workers(Workers&&) noexcept = default;
Workers& Workers::operator=(Workers&&) noexcept = default;

unsigned Workers::threads() const {
  return pool_ ? static_cast<unsigned>(pool_->threads.size()) + 1 : 1;
}

void Workers::run_shared(const Job& job) {
  pool_->run(job);
}

}  // namespace neritic::sim
