// Sensors ping at their own rates whatever the frames' rate, numbered one by one.
#include "testbed/sensors/ping_schedule.hpp"

#include <gtest/gtest.h>

namespace neritic::testbed {
namespace {

std::vector<std::vector<std::uint32_t>> pings_of(const std::vector<double>& rates_hz,
                                                 double frames_hz, int frames, double start_s = 0) {
  PingSchedule schedule(rates_hz);
  std::vector<std::vector<std::uint32_t>> frames_with(rates_hz.size());
  std::vector<std::uint32_t> next(rates_hz.size(), 0);
  for (int i = 0; i < frames; ++i)
    for (const PingSchedule::Due& due : schedule.due(start_s + i / frames_hz)) {
      EXPECT_EQ(due.number, next[due.sensor]++);
      frames_with[due.sensor].push_back(static_cast<std::uint32_t>(i));
    }
  return frames_with;
}

TEST(PingSchedule, ASensorIsDueAtTheMultiplesOfItsPeriod) {
  const auto frames = pings_of({30, 10, 7.5}, 30, 13);
  EXPECT_EQ(frames[0].size(), 13u);
  EXPECT_EQ(frames[1], (std::vector<std::uint32_t>{0, 3, 6, 9, 12}));
  EXPECT_EQ(frames[2], (std::vector<std::uint32_t>{0, 4, 8, 12}));
  EXPECT_EQ(pings_of({10}, 30, 13, 1e6)[0], frames[1]);
}

TEST(PingSchedule, KeepsItsBeatWhereFramesDoNotFallOnIt) {
  // 10 pings a second seen in 24 frames a second: after 100 s none is lost or added.
  EXPECT_NEAR(static_cast<double>(pings_of({10}, 24, 2401)[0].size()), 1001.0, 1.0);
}

TEST(PingSchedule, ALateSensorPingsOnceNotForEveryPingMissed) {
  PingSchedule schedule({100.0});
  ASSERT_EQ(schedule.due(0.0).size(), 1u);
  EXPECT_EQ(schedule.due(5.0).size(), 1u);
  EXPECT_TRUE(schedule.due(5.001).empty());
  EXPECT_EQ(schedule.due(5.011).size(), 1u);
}

std::vector<int> steps_due(double rate_hz, int first, int last, int step_hz = 240) {
  PingSchedule schedule({rate_hz}, PingSchedule::Begin::kOnBeat);
  std::vector<int> out;
  for (int step = first; step <= last; ++step)
    if (!schedule.due(step * (1.0 / step_hz)).empty()) out.push_back(step);
  return out;
}

TEST(PingSchedule, OnBeatASensorIsDueAtMultiplesOfItsPeriodWhereverItBegins) {
  EXPECT_EQ(steps_due(10, 0, 72), (std::vector<int>{0, 24, 48, 72}));
  EXPECT_EQ(steps_due(10, 1, 72), (std::vector<int>{24, 48, 72}));
  EXPECT_EQ(steps_due(10, 24, 72), (std::vector<int>{24, 48, 72}));
  EXPECT_EQ(steps_due(10, 25, 72), (std::vector<int>{48, 72}));
  // Where no step falls on a multiple, the first one after it.
  EXPECT_EQ(steps_due(7, 1, 140), (std::vector<int>{35, 69, 103, 138}));
  // Step 3, 12.5 ms, begins between two multiples; then each step has passed one.
  EXPECT_EQ(steps_due(1000, 3, 6), (std::vector<int>{4, 5, 6}));
}

TEST(PingSchedule, OnBeatALateFrameMovesNoLaterOne) {
  PingSchedule schedule({10.0}, PingSchedule::Begin::kOnBeat);
  EXPECT_EQ(schedule.due(0.0).size(), 1u);
  EXPECT_EQ(schedule.due(0.37).size(), 1u);
  EXPECT_TRUE(schedule.due(0.39).empty());
  EXPECT_EQ(schedule.due(0.4).size(), 1u);
  // Back, and forward where it says so.
  EXPECT_TRUE(schedule.due(0.05).empty());
  EXPECT_EQ(schedule.due(0.1).size(), 1u);
  schedule.restart();
  EXPECT_TRUE(schedule.due(7.03).empty());
  EXPECT_EQ(schedule.due(7.1).size(), 1u);
}

}  // namespace
}  // namespace neritic::testbed
