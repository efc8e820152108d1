#include "engine/net/clock_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "engine/core/random.hpp"
#include "engine/net/counter_track.hpp"
#include "engine/net/rough_link.hpp"

namespace neritic::net {
namespace {

constexpr double kSecond = 1e9;

// A device that sends at a rate over a link with 20 ms of jitter and 2 % loss; its clock was set
// otherwise and drifts. Feeds the map in the order of arrival; gives the error at the end.
struct DeviceRun {
  double rate_hz = 240.0, seconds = 90.0;
  double drift = 80e-6;
  TimeNs offset_ns = 1'234'567'890'123;
  std::uint64_t seed = 1;

  TimeNs device(TimeNs host_ns) const {
    return host_ns - offset_ns - static_cast<TimeNs>(drift * static_cast<double>(host_ns));
  }
  TimeNs error_ns(ClockMap& map) const {
    RoughLink link({.jitter_s = 0.02, .loss = 0.02, .seed = seed});
    for (int i = 0; i < static_cast<int>(rate_hz * seconds); ++i) {
      const auto at = static_cast<TimeNs>(kSecond * i / rate_hz);
      const TimeNs sent = device(at);
      const auto* bytes = reinterpret_cast<const std::byte*>(&sent);
      link.send(at, {bytes, bytes + sizeof sent});
    }
    while (!link.empty()) {
      const auto packet = link.take_next();
      TimeNs sent = 0;
      std::memcpy(&sent, packet.bytes.data(), sizeof sent);
      map.add(sent, packet.due_ns);
    }
    const auto end = static_cast<TimeNs>(kSecond * seconds);
    return map.to_host(device(end)) - end;
  }
};

TEST(ClockMap, OffsetsAreFoundWithinAMillisecondUnderLossAndJitter) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed)
    for (const double rate_hz : {240.0, 50.0}) {
      ClockMap map;
      const DeviceRun run{.rate_hz = rate_hz, .seed = seed};
      EXPECT_LT(std::abs(run.error_ns(map)), 1'000'000) << seed << " at " << rate_hz;
      EXPECT_NEAR(map.estimate().drift_ppm, 80.0, 15.0) << seed << " at " << rate_hz;
      EXPECT_NEAR(map.estimate().spread_ms, 10.0, 1.5);
      EXPECT_LE(map.estimate().longest_ms, 20.5);
      EXPECT_EQ(map.estimate().jumps, 0u);
    }
}

TEST(ClockMap, NoClockIsAheadOfWhatCouldArrive) {
  for (const double drift : {-400e-6, 0.0, 400e-6}) {
    ClockMap map;
    const DeviceRun run{.rate_hz = 100.0, .drift = drift};
    EXPECT_LT(std::abs(run.error_ns(map)), 1'000'000) << drift;
  }
}

TEST(ClockMap, AClockThatIsSetAnewIsFoundAgain) {
  for (const TimeNs set_ns : {TimeNs{-50} * 1'000'000'000, TimeNs{50} * 1'000'000'000}) {
    ClockMap map;
    for (int i = 0; i < 2000; ++i) map.add(TimeNs{i} * 10'000'000, TimeNs{i} * 10'000'000);
    for (int i = 2000; i < 4000; ++i)
      map.add(TimeNs{i} * 10'000'000 + set_ns, TimeNs{i} * 10'000'000);
    EXPECT_EQ(map.estimate().jumps, 1u) << set_ns;
    EXPECT_NEAR(map.estimate().offset_s, -1e-9 * static_cast<double>(set_ns), 1e-3);
  }
}

// A bit of a packet's time flips on the way; of every other device that of the first packet too.
TEST(ClockMap, PacketsWithAWrongTimeDoNotMoveIt) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed)
    for (const double rate_hz : {240.0, 50.0}) {
      const double seconds = 60.0, corrupt = 0.02;
      const TimeNs offset_ns = -15'550'842'000'000;
      ClockMap map;
      double worst_s = 0.0;
      for (int i = 0; i < static_cast<int>(rate_hz * seconds); ++i) {
        const RandomKey key{seed, 7, static_cast<std::uint64_t>(i)};
        const auto at = static_cast<TimeNs>(kSecond * i / rate_hz);
        TimeNs sent = at - offset_ns + at / 28'000;  // 35.7 ppm
        if (random_uniform(key, 0) < corrupt || (i == 0 && seed % 2 == 0))
          sent ^= TimeNs{1} << static_cast<int>(random_uniform(key, 1) * 50.0);
        map.add(sent, at + static_cast<TimeNs>(5e6 * random_uniform(key, 2)));
        if (i < rate_hz * seconds / 2) continue;
        const double error_s =
            1e-9 * static_cast<double>(map.to_host(at - offset_ns + at / 28'000) - at);
        worst_s = std::max(worst_s, std::abs(error_s));
      }
      EXPECT_LT(worst_s, 1e-3) << seed << " at " << rate_hz;
      EXPECT_NEAR(map.estimate().drift_ppm, -35.7, 25.0) << seed << " at " << rate_hz;
      EXPECT_LE(map.estimate().jumps, 1u) << seed << " at " << rate_hz;
    }
}

// A gap, as of a wireless link that was lost for a moment, does not make the device a slow one.
TEST(ClockMap, AWrongTimeAfterAGapDoesNotMoveIt) {
  constexpr TimeNs kOutageEvery_ns = 5'000'000'000, kOutageFrom_ns = 4'600'000'000;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    ClockMap map;
    double worst_s = 0.0;
    for (int i = 0; i < 60 * 240; ++i) {
      const RandomKey key{seed, 8, static_cast<std::uint64_t>(i)};
      const auto at = static_cast<TimeNs>(kSecond * i / 240.0);
      if (at % kOutageEvery_ns > kOutageFrom_ns) continue;
      TimeNs sent = at;
      if (random_uniform(key, 0) < 0.02)
        sent ^= TimeNs{1} << static_cast<int>(random_uniform(key, 1) * 50.0);
      map.add(sent, at + static_cast<TimeNs>(5e6 * random_uniform(key, 2)));
      if (i < 30 * 240) continue;
      worst_s = std::max(worst_s, std::abs(1e-9 * static_cast<double>(map.to_host(at) - at)));
    }
    EXPECT_LT(worst_s, 1e-3) << seed;
  }
}

TEST(ClockMap, AnExchangeTellsADelayFromAnOffset) {
  // The device's clock is 9.995 s ahead; each way takes 5 ms, its answer 2 ms.
  ClockMap map;
  map.add_exchange(10'000'000'000, 20'000'000'000, 20'002'000'000, 10'012'000'000);
  EXPECT_NEAR(map.estimate().offset_s, -9.995, 1e-9);
}

TEST(ClockMap, ExtremesDoNotOverturnIt) {
  ClockMap map;
  map.add(0, 0);
  map.add(INT64_MAX / 4, 1);
  map.add(INT64_MAX / 4 + 1, 2);
  map.add(-INT64_MAX / 4, 3);
  EXPECT_TRUE(std::isfinite(map.estimate().offset_s));
}

TEST(CounterTrack, WrapsRepeatsAndGapsAreFound) {
  using enum CounterTrack::Verdict;
  LinkCounts counts;
  CounterTrack track(16);
  EXPECT_EQ(track.take(65534, 0, counts), kNew);
  EXPECT_EQ(track.take(65535, 1, counts), kNew);
  EXPECT_EQ(track.take(0, 2, counts), kNew);
  EXPECT_EQ(track.take(3, 3, counts), kNew);
  EXPECT_EQ(track.newest(), 65539u);
  EXPECT_EQ(counts.lost, 2u);
  EXPECT_EQ(track.take(1, 4, counts), kOlder);
  EXPECT_EQ(track.take(1, 4, counts), kRepeated);
  EXPECT_EQ(track.take(65535, 4, counts), kRepeated);
  EXPECT_EQ(counts.lost, 1u);
  EXPECT_EQ(counts.older, 1u);
  EXPECT_EQ(counts.repeated, 2u);
}

// A device says whatever it likes; its clock is right again once it says what a clock says.
TEST(ClockMap, TimesAtTheEndsOfWhatANumberHoldsAreForgotten) {
  constexpr TimeNs kLeast = std::numeric_limits<TimeNs>::min(),
                   kMost = std::numeric_limits<TimeNs>::max();
  const auto all_finite = [](const ClockEstimate& e) {
    return std::isfinite(e.offset_s) && std::isfinite(e.drift_ppm) && std::isfinite(e.spread_ms) &&
           std::isfinite(e.longest_ms);
  };
  for (const TimeNs first : {kLeast, kLeast + 1, TimeNs{0}, kMost / 2 + 1, kMost}) {
    ClockMap clock;
    TimeNs now = 1'286'000'000;
    for (const TimeNs said :
         {first, kMost, kLeast, kMost - 7, kLeast / 2, first, TimeNs{0}, kMost}) {
      clock.add(said, now += 10'000'000);
      clock.add_exchange(said, kLeast, kMost, now);
      EXPECT_TRUE(all_finite(clock.estimate())) << first << ' ' << said;
    }
    for (int i = 0; i < 2000; ++i) {
      now += 10'000'000;
      clock.add(now - 5'000'000'000, now + 1'000'000);
    }
    EXPECT_NEAR(clock.estimate().offset_s, 5.001, 1e-4) << first;
  }
}

TEST(CounterTrack, OneCorruptNumberDoesNotMakeGoodOnesOld) {
  using enum CounterTrack::Verdict;
  LinkCounts counts;
  CounterTrack track(16);
  EXPECT_EQ(track.take(100, 0, counts), kNew);
  EXPECT_EQ(track.take(20'000, 1, counts), kDoubtful);
  EXPECT_EQ(track.take(101, 2, counts), kNew);
  EXPECT_EQ(track.take(5'000, 3, counts), kDoubtful);
  EXPECT_EQ(track.take(5'001, 4, counts), kRestarted);
  EXPECT_EQ(counts.restarts, 1u);
  EXPECT_EQ(counts.lost, 0u);
}

// Numbers that rise by more than 2: a program that sends every fourth frame, loss, or both. After a
// pause, in which more went by than may be missing, they count again, over a wrap too and if some
// come late or twice; meanwhile the reason is told.
TEST(CounterTrack, NumbersOfAnyStepCountAgainAfterAPause) {
  using enum CounterTrack::Verdict;
  for (const int bits : {16, 32})
    for (const std::uint64_t step : {1, 2, 3, 4, 10, 250, 1000})
      for (const bool rough : {false, true}) {
        SCOPED_TRACE(fmt::format("{} bits, step {}, rough {}", bits, step, rough));
        const std::uint64_t mask = (std::uint64_t{1} << bits) - 1;
        LinkCounts counts;
        CounterTrack track(bits);
        TimeNs now = 0;
        const auto take = [&](std::uint64_t value) {
          return track.take(value & mask, now += 4'000'000, counts);
        };
        std::uint64_t value = mask - 20 * step - 5000;
        for (int i = 0; i < 20; ++i) EXPECT_EQ(take(value += step), kNew);
        now += 3'000'000'000;
        value += 5000 - 2 * step;  // the wrap is near
        int until = 0;
        std::string told;
        for (bool found = false; !found && until < 20; ++until) {
          value += step;
          found = take(value) == kRestarted;
          told += track.trouble();
          if (rough && !found && until % 2 == 1) {
            EXPECT_EQ(take(value), kDoubtful);
          }
        }
        EXPECT_LE(until, 4);
        EXPECT_EQ(counts.restarts, 1u);
        EXPECT_EQ(track.trouble(), "");
        for (int i = 0; i < 20; ++i) EXPECT_EQ(take(value += step), kNew);
        EXPECT_EQ(told.empty(), step <= 2) << told;
      }
}

// Every second number is wrong; or none goes on from any other.
TEST(CounterTrack, NumbersThatAgreeWithNothingAreToldAndDoNotCount) {
  using enum CounterTrack::Verdict;
  LinkCounts counts;
  CounterTrack track(32);
  EXPECT_EQ(track.take(100, 0, counts), kNew);
  for (std::uint64_t i = 1; i < 1000; ++i) {
    EXPECT_EQ(track.take(1'000'000 + 500 * i, static_cast<TimeNs>(i), counts), kDoubtful);
    EXPECT_EQ(track.take(100 + i, static_cast<TimeNs>(i), counts), kNew);
    EXPECT_EQ(track.trouble(), "");
  }
  for (std::uint64_t i = 1; i < 100; ++i)
    EXPECT_EQ(track.take(5'000'000 + 2000 * i, static_cast<TimeNs>(i), counts), kDoubtful);
  EXPECT_EQ(track.trouble(), "its packets' numbers leap by more than 1000");
  EXPECT_EQ(counts.restarts, 0u);
  EXPECT_EQ(track.take(1100, 2000, counts), kNew);
  EXPECT_EQ(track.trouble(), "");
}

TEST(RoughLink, TheSameSeedGivesTheSameFaults) {
  const auto run = [](std::uint64_t seed) {
    RoughLink link({.delay_s = 0.01, .jitter_s = 0.02, .loss = 0.1, .repeat = 0.1, .seed = seed});
    for (int i = 0; i < 10'000; ++i) link.send(i * 1000, {static_cast<std::byte>(i)});
    std::vector<TimeNs> times;
    while (!link.empty()) times.push_back(link.take_next().due_ns);
    EXPECT_NEAR(static_cast<double>(link.lost()), 1000.0, 150.0);
    EXPECT_NEAR(static_cast<double>(times.size()), 9900.0, 200.0);
    EXPECT_TRUE(std::ranges::is_sorted(times));
    return times;
  };
  EXPECT_EQ(run(1), run(1));
  EXPECT_NE(run(1), run(2));
}

}  // namespace
}  // namespace neritic::net
