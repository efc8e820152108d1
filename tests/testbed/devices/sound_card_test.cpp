// A microphone at a sound card, by a stand-in for ALSA's library (tests/fakes/alsa): heard, run
// over, pulled out and put back.
#include <chrono>
#include <thread>

#include "tests/fakes/alsa/fake_alsa.hpp"
#include "tests/testbed/devices/lab_scene.hpp"

namespace neritic::testbed {
namespace {

constexpr std::size_t kPacket = 320;  // 20 ms at 16 kHz

struct SoundLab {
  SoundLab() : dive(dive_of(lab_text("mic = \"microphone alsa hw:1\"\n"))) {
    auto opened = DeviceSource::open(dive.scene.sources.at(0), *dive.world,
                                     dive.simulation->inbox(), DeviceSource::Pace::kThread);
    EXPECT_TRUE(opened.ok()) << opened.error().message;
    if (opened.ok()) source = std::move(opened).value();
  }
  bool until(const std::function<bool()>& done) const {
    for (int i = 0; i < 1000 && !done(); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return done();
  }
  net::LinkCounts counts() const { return source->health().link; }
  TestDive dive;
  std::unique_ptr<DeviceSource> source;
};

TEST(SoundCard, IsHeardAndIfPulledOutLookedForAgain) {
  test::FakeAlsa alsa;
  const std::vector<std::int16_t> sound(10 * kPacket, 1000);
  {
    SoundLab lab;
    ASSERT_TRUE(lab.source);
    EXPECT_EQ(alsa.rate_hz(), 16'000u);
    alsa.push(sound);
    ASSERT_TRUE(lab.until([&] { return lab.counts().used == 10; }));
    EXPECT_EQ(lab.source->health().trouble, "");
    alsa.overrun();
    ASSERT_TRUE(lab.until([&] { return lab.counts().overflowed == 1; }));
    EXPECT_EQ(alsa.opens(), 1);
    alsa.plug(false);
    ASSERT_TRUE(lab.until([&] { return alsa.opened() == 0; }));
    ASSERT_TRUE(lab.until([&] { return !lab.source->health().trouble.empty(); }));
    EXPECT_EQ(lab.source->health().trouble, "the card: No such device");
    alsa.plug(true);
    ASSERT_TRUE(lab.until([&] { return alsa.opens() == 2; }));
    alsa.push(sound);
    ASSERT_TRUE(lab.until([&] { return lab.counts().used == 20; }));
    EXPECT_EQ(lab.source->health().trouble, "");
    EXPECT_EQ(lab.counts().overflowed, 1u);
    EXPECT_GE(lab.counts().lost, 40u);  // it is looked for once a second
    expect_adds_up(lab.counts());
  }
  EXPECT_EQ(alsa.opened(), 0);
}

// Longer than the 20 s over which packets count as lost one by one: a restart. The first packet, of
// 20 ms, is the one that is far ahead; the next one confirms it (CounterTrack).
TEST(SoundCard, OneThatIsAbsentForMoreThanTwentySecondsComesBack) {
  test::FakeAlsa alsa;
  const std::vector<std::int16_t> sound(10 * kPacket, 1000);
  SoundLab lab;
  ASSERT_TRUE(lab.source);
  alsa.push(sound);
  ASSERT_TRUE(lab.until([&] { return lab.counts().used == 10; }));
  alsa.plug(false);
  ASSERT_TRUE(lab.until([&] { return alsa.opened() == 0; }));
  std::this_thread::sleep_for(std::chrono::milliseconds(21'500));
  EXPECT_EQ(lab.source->health().trouble, "the card: No such device");
  EXPECT_EQ(alsa.opens(), 1);
  alsa.plug(true);
  ASSERT_TRUE(lab.until([&] { return alsa.opens() == 2; }));
  alsa.push(sound);
  ASSERT_TRUE(lab.until([&] { return lab.counts().used == 19; }));
  EXPECT_EQ(lab.source->health().trouble, "");
  EXPECT_EQ(lab.counts().restarts, 1u);
  EXPECT_EQ(lab.counts().malformed, 1u);
  EXPECT_EQ(lab.counts().lost, 0u);
  EXPECT_EQ(lab.counts().repeated + lab.counts().older, 0u);
  expect_adds_up(lab.counts());
}

TEST(SoundCard, OneThatIsNotThereIsRefusedInOneLine) {
  test::FakeAlsa alsa;
  alsa.plug(false);
  TestDive dive = dive_of(lab_text("mic = \"microphone alsa hw:1\"\n"));
  const auto opened = DeviceSource::open(dive.scene.sources.at(0), *dive.world,
                                         dive.simulation->inbox(), DeviceSource::Pace::kThread);
  ASSERT_FALSE(opened.ok());
  EXPECT_EQ(opened.error().message, "source mic: sound card hw:1: No such file or directory");
}

}  // namespace
}  // namespace neritic::testbed
