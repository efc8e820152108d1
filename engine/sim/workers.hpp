// Threads that share the tasks of a step: run(n, task) calls task(i, thread) for i = 0 to n - 1,
// each once and in any order, thread being 0 to threads() - 1, and returns when all are done. Tasks
// that write nothing in common give the same bits for any number of threads. One thread at a time
// calls run(), which allocates nothing.
#pragma once

#include <cstddef>
#include <memory>

namespace neritic::sim {

inline constexpr unsigned kMostThreads = 256;  // that a user may ask for

class Workers {
 public:
  // threads: the caller's included; 1 starts none.
  explicit Workers(unsigned threads = 1);
  ~Workers();
  // A copy starts as many threads of its own.
  Workers(const Workers& other);
  Workers(Workers&&) noexcept;
  Workers& operator=(const Workers&) = delete;
  Workers& operator=(Workers&&) noexcept;

  unsigned threads() const;

  template <class Task>
  void run(std::size_t count, const Task& task) {
    if (pool_ && count > 1)
      run_shared({[](const void* to, std::size_t i, unsigned thread) {
                    (*static_cast<const Task*>(to))(i, thread);
                  },
                  &task, count});
    else
      for (std::size_t i = 0; i < count; ++i) task(i, 0u);
  }

 private:
  struct Job {
    void (*call)(const void* task, std::size_t i, unsigned thread) = nullptr;
    const void* task = nullptr;
    std::size_t count = 0;
  };
  struct Pool;
  void run_shared(const Job& job);

  std::unique_ptr<Pool> pool_;  // null: the calling thread alone
};

}  // namespace neritic::sim
