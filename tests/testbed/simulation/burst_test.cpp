// A million samples pushed while the simulation's thread steps in real time: no step takes longer
// than its period, and each sample is used, dropped or refused, and counted as such.
#include <ctime>
#include <thread>

#include "tests/testbed/simulation/devices.hpp"

namespace neritic::testbed {
namespace {

constexpr std::uint64_t kBurst = 1'000'000;

TimeNs thread_cpu_ns() {
  timespec time{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return TimeNs{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

// The time that the stepping thread computes from one step to the next: drain, step, hash,
// snapshot and log. Not the time that the machine gives to others.
struct StepTimes {
  TimeNs last_ns = -1, worst_ns = 0;
  std::uint64_t steps = 0;
  void note() {
    const TimeNs now_ns = thread_cpu_ns();
    if (last_ns >= 0) worst_ns = std::max(worst_ns, now_ns - last_ns);
    last_ns = now_ns;
    ++steps;
  }
};

struct Counted {
  std::uint64_t accepted = 0, refused = 0;
  void add(SampleVerdict verdict) { ++(verdict == SampleVerdict::kAccepted ? accepted : refused); }
};

// One sample in ten repeats the one before; one in a thousand is of another kind than its stream.
Counted push_burst(Device& noise) {
  Counted counted;
  for (std::uint64_t i = 0; i < kBurst; ++i) {
    if (i % 10 == 9) --noise.sequence;
    counted.add(i % 1000 == 500 ? noise.say(JacketButtons{}) : noise.say(GasSupply{}));
  }
  return counted;
}

// Runs one burst; the longest time that a step took to compute.
TimeNs burst_once(const PhysicsWorld& world) {
  StepTimes times;
  PhysicsSimulation simulation(
      {.step_s = world.step_s(), .log = true}, world.start(), world.start_inputs(),
      std::make_unique<SampleInbox>(world.streams(), SampleInbox::kCapacity),
      [&times, step = world.step_function()](const PhysicsState& before,
                                             const PhysicsInputs& inputs, const sim::StepTime& time,
                                             PhysicsState& after) {
        times.note();
        step(before, inputs, time, after);
      },
      [&world](PhysicsInputs& inputs, const Sample& sample, std::uint64_t step) {
        world.apply(inputs, sample, step);
      });
  Device noise(simulation.inbox(), world.streams(), "noise", "diver/gas");
  sim::HostClock clock;
  simulation.start(clock);
  Counted pushed;
  std::jthread burst([&] { pushed = push_burst(noise); });
  burst.join();
  simulation.stop();
  const StepTimes beside = times;  // the step to come is this thread's
  simulation.advance(1);           // drains the rest

  const SourceCounts counts = simulation.inbox().counts(noise.source);
  const std::uint64_t used = simulation.inputs().humans()[0].of(DiverGroup::kGas).heard;
  EXPECT_EQ(counts.accepted, pushed.accepted);
  EXPECT_EQ(counts.refused(), pushed.refused);
  EXPECT_EQ(pushed.refused, kBurst / 10 + kBurst / 1000);
  EXPECT_EQ(used + counts.dropped + counts.refused(), kBurst);
  EXPECT_EQ(simulation.log().entries.size(), used);
  EXPECT_GE(used, SampleInbox::kCapacity);
  // Some steps ran meanwhile, and not all of them waited in vain for their samples.
  EXPECT_GT(beside.steps, 5u);
  EXPECT_LT(simulation.inbox().postponed(), beside.steps);
  return beside.worst_ns;
}

TEST(Burst, OfAMillionSamplesMakesNoStepLateAndEachSampleIsCounted) {
  const TestDive dive = dive_of(hover_text("gas = \"noise\""));
  const auto period_ns = static_cast<TimeNs>(dive.world->step_s() * 1e9);
  // A fault makes steps late in every run; the host of a virtual machine does so now and then.
  TimeNs least_worst_ns = burst_once(*dive.world);
  for (int i = 0; i < 2 && least_worst_ns > period_ns; ++i)
    least_worst_ns = std::min(least_worst_ns, burst_once(*dive.world));
  RecordProperty("worst_step_us", std::to_string(least_worst_ns / 1000));
#if !defined(__SANITIZE_THREAD__) && !defined(__SANITIZE_ADDRESS__)  // which make all of it slower
  EXPECT_LT(least_worst_ns, period_ns);
#endif
}

}  // namespace
}  // namespace neritic::testbed
