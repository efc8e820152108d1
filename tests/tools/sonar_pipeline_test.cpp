// The worker pool of `neritic sonar` on folders: every frame once, bounded, with errors and
// exceptions. No device, no files: what ThreadSanitizer is to look at.
#include "tools/neritic/sonar_pipeline.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>

namespace neritic {
namespace {

using Numbers = tools::Pipeline<std::vector<int>, int>;

// Reads {i, i, ...}, sums, and keeps each frame's sum.
struct Sums {
  static constexpr std::size_t kFrames = 1000, kSize = 64;
  std::vector<int> written = std::vector<int>(kFrames, -1);
  std::atomic<int> in_flight{0}, most_in_flight{0}, processing{0};
  int finished = 0;  // one call at a time
  std::thread::id caller = std::this_thread::get_id();
  bool only_caller_processes = true;

  Numbers::Steps steps() {
    Numbers::Steps s;
    s.read = [this](std::size_t i) -> Result<std::optional<std::vector<int>>> {
      const int now = ++in_flight;
      int most = most_in_flight;
      while (now > most && !most_in_flight.compare_exchange_weak(most, now)) {
      }
      return std::optional(std::vector<int>(kSize, static_cast<int>(i)));
    };
    s.process = [this](std::size_t, std::vector<int> in) -> Result<int> {
      only_caller_processes &= std::this_thread::get_id() == caller && ++processing == 1;
      int sum = 0;
      for (const int v : in) sum += v;
      --processing;
      return sum;
    };
    s.write = [this](std::size_t i, int sum) -> Status {
      written[i] = written[i] == -1 ? sum : -2;
      --in_flight;
      return {};
    };
    s.finished = [this] { ++finished; };
    return s;
  }
};

TEST(SonarPipeline, AStopLetsWhatIsUnderWayThroughAndReadsNoMore) {
  for (const std::size_t workers : {1u, 2u, 7u}) {
    Sums run;
    std::atomic<int> read{0};
    Numbers::Steps steps = run.steps();
    steps.read = [&read, inner = steps.read](std::size_t i) {
      ++read;
      return inner(i);
    };
    steps.stopped = [&read] { return read >= 100; };
    ASSERT_TRUE(Numbers({Sums::kFrames, workers, 5}, steps).run().ok());
    EXPECT_GE(read, 100);
    EXPECT_LT(read, 110);
    EXPECT_EQ(run.finished, read);
    for (std::size_t i = 0; i < static_cast<std::size_t>(read); ++i)
      ASSERT_EQ(run.written[i], static_cast<int>(i * Sums::kSize)) << workers;
  }
}

TEST(SonarPipeline, EveryFrameGoesThroughOnceWithAnyNumberOfWorkers) {
  for (const std::size_t workers : {1u, 2u, 7u}) {
    for (const std::size_t bound : {1u, 3u, 16u}) {
      Sums run;
      ASSERT_TRUE(Numbers({Sums::kFrames, workers, bound}, run.steps()).run().ok());
      EXPECT_EQ(run.finished, static_cast<int>(Sums::kFrames));
      EXPECT_TRUE(run.only_caller_processes);
      EXPECT_LE(run.most_in_flight, static_cast<int>(bound));
      for (std::size_t i = 0; i < Sums::kFrames; ++i)
        ASSERT_EQ(run.written[i], static_cast<int>(i * Sums::kSize)) << workers << " " << bound;
    }
  }
}

TEST(SonarPipeline, NoFramesAreNoWork) {
  Sums run;
  EXPECT_TRUE(Numbers({0, 2, 3}, run.steps()).run().ok());
  EXPECT_EQ(run.finished, 0);
}

TEST(SonarPipeline, FramesThatAreLeftOutDoNotStopTheOthers) {
  Sums run;
  auto steps = run.steps();
  const auto read = steps.read;
  steps.read = [&](std::size_t i) -> Result<std::optional<std::vector<int>>> {
    if (i % 3 == 0) return std::optional<std::vector<int>>();
    return read(i);
  };
  ASSERT_TRUE(Numbers({Sums::kFrames, 3, 5}, steps).run().ok());
  EXPECT_EQ(run.finished, static_cast<int>(Sums::kFrames));
  for (std::size_t i = 0; i < Sums::kFrames; ++i)
    ASSERT_EQ(run.written[i], i % 3 == 0 ? -1 : static_cast<int>(i * Sums::kSize));
}

TEST(SonarPipeline, TheFirstErrorOfAnyStepEndsTheRun) {
  for (const int step : {0, 1, 2}) {
    Sums run;
    auto steps = run.steps();
    const Error error = bad_input("step {} of frame 20", step);
    const auto read = steps.read;
    const auto process = steps.process;
    const auto write = steps.write;
    if (step == 0)
      steps.read = [&](std::size_t i) -> Result<std::optional<std::vector<int>>> {
        if (i == 20) return error;
        return read(i);
      };
    if (step == 1)
      steps.process = [&](std::size_t i, std::vector<int> in) -> Result<int> {
        if (i == 20) return error;
        return process(i, std::move(in));
      };
    if (step == 2)
      steps.write = [&](std::size_t i, int sum) -> Status {
        if (i == 20) return error;
        return write(i, sum);
      };
    const Status status = Numbers({Sums::kFrames, 4, 6}, steps).run();
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(status.error().message, error.message);
    EXPECT_LT(run.finished, 40);  // nothing is begun after it
    EXPECT_EQ(run.written[20], -1);
  }
}

TEST(SonarPipeline, WhatAStepThrowsIsItsError) {
  Sums run;
  auto steps = run.steps();
  steps.write = [](std::size_t i, int) -> Status {
    if (i == 5) throw std::runtime_error("a library's complaint");
    return {};
  };
  const Status status = Numbers({Sums::kFrames, 2, 4}, steps).run();
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().message, "a library's complaint");
  steps.read = [](std::size_t) -> Result<std::optional<std::vector<int>>> {
    throw std::bad_alloc();
  };
  const Status memory = Numbers({Sums::kFrames, 2, 4}, steps).run();
  ASSERT_FALSE(memory.ok());
  EXPECT_EQ(memory.error().code, ErrorCode::kOutOfMemory);
}

}  // namespace
}  // namespace neritic
