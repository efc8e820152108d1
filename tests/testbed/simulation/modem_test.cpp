// Modems of a scene: messages that take their time, ranges by a USBL, and a run with both recorded,
// repeated, saved and restored.
#include "testbed/simulation/mission_outlook.hpp"
#include "testbed/simulation/output_samples.hpp"
#include "tests/testbed/simulation/dives.hpp"
#include "tests/testbed/simulation/replay_run.hpp"

namespace neritic::testbed {
namespace {

// An ROV at the origin and one so far north of it, each 6 m deep; keys of the scene follow.
std::string two_text(double north_m, const std::string& modem = "modem = { fading = false }\n",
                     const std::string& keys = {}) {
  return std::string(kStillWater) + keys + rov_text("position_m = [0, -6, 0]\n" + modem, "ada") +
         rov_text(fmt::format("position_m = [0, -6, {}]\nmodem = {{ fading = false }}\n", -north_m),
                  "bob");
}

TestDive two(const std::string& text) {
  return dive_of(load_text(text).value());
}

// As a client sends it.
void say(TestDive& dive, const std::string& stream, std::uint64_t to, std::uint64_t bytes,
         std::uint32_t word = 0x31323334u) {
  static std::uint64_t sequence = 0;
  SampleInbox& inbox = dive.simulation->inbox();
  const SourceId source = inbox.open("client").value();
  const auto now = static_cast<TimeNs>(dive.time_s() * 1e9);
  ModemSend send{.to = to, .bytes = bytes};
  send.words[0] = word;
  EXPECT_EQ(inbox.push(
                {{dive.world->streams().find(stream).value(), source, sequence++, now, now}, send}),
            SampleVerdict::kAccepted);
}

std::vector<ModemReading> heard(TestDive& dive, const std::string& stream, double seconds) {
  OutputSamples outputs(*dive.world, {dive.world->streams().find(stream).value()});
  std::vector<ModemReading> all;
  std::uint64_t next = 0;
  bool begun = false;
  dive.run(seconds, [&] {
    for (const Sample& sample : outputs.of(dive.simulation->newest())) {
      if (begun) {
        EXPECT_EQ(sample.header.sequence, next);
      }
      begun = true, next = sample.header.sequence + 1;
      EXPECT_LE(sample.header.captured_ns, sample.header.arrived_ns);
      all.push_back(std::get<ModemReading>(sample.payload));
    }
  });
  return all;
}

TEST(SceneModem, AMessageTakesItsTravelAndSaysWhatWasSent) {
  TestDive dive = two(two_text(300.0));
  say(dive, "ada/send", 2, 4);
  const auto got = heard(dive, "bob/modem", 1.0);
  ASSERT_EQ(got.size(), 1u);
  EXPECT_EQ(got[0].event, ModemEvent::kReceived);
  EXPECT_EQ(got[0].from, 1u);
  EXPECT_EQ(got[0].to, 2u);
  EXPECT_EQ(got[0].bytes, 4u);
  EXPECT_EQ(got[0].words[0], 0x31323334u);
  // Mackenzie at 10 C, 35 psu, 6 m: 1489.90 m/s.
  EXPECT_NEAR(got[0].heard_s - got[0].sent_s, 300.0 / 1489.90, 1e-4);
  EXPECT_EQ(dive.state().modems()[0].counts.sent, 1u);
}

TEST(SceneModem, LossesAreToldWithTheirCauseAndRefusalsToTheSender) {
  TestDive dive = two(two_text(300.0));
  say(dive, "ada/send", 0, 20), say(dive, "bob/send", 0, 20);
  say(dive, "ada/send", 0, 20);   // it is sending
  say(dive, "bob/send", 99, 20);  // nobody
  say(dive, "bob/send", 0, 65);   // too long
  const auto got = heard(dive, "ada/modem", 2.0);
  ASSERT_EQ(got.size(), 3u);
  EXPECT_EQ(got[0].event, ModemEvent::kSent);
  EXPECT_EQ(got[1].event, ModemEvent::kRefused);
  // Both sent at once: each was still sending as the other's first sound came.
  EXPECT_EQ(got[2].event, ModemEvent::kWasSending);
  EXPECT_EQ(got[2].words[0], 0u);
  EXPECT_EQ(dive.state().modems()[1].counts.refused, 2u);
}

// Each has its event, in order, with its content: the first goes out, the others find it sending.
TEST(SceneModem, EachOfManyMessagesInAStepHasItsEvent) {
  TestDive dive = two(two_text(300.0));
  for (std::uint32_t i = 0; i < ModemQueue::kMost; ++i) say(dive, "ada/send", 2, 20, i);
  const auto got = heard(dive, "ada/modem", 0.2);
  ASSERT_EQ(got.size(), ModemQueue::kMost);
  for (std::uint32_t i = 0; i < got.size(); ++i) {
    EXPECT_EQ(got[i].event, i == 0 ? ModemEvent::kSent : ModemEvent::kRefused) << i;
    EXPECT_EQ(got[i].to, 2u) << i;
    EXPECT_EQ(got[i].bytes, 20u) << i;
    EXPECT_EQ(got[i].words[0], i);
  }
}

// A flood leaves those that came first; the queue has room again once they are handled.
TEST(SceneModem, AFloodKeepsTheMessagesThatCameFirst) {
  TestDive dive = two(two_text(300.0));
  for (std::uint32_t i = 0; i < 500; ++i) say(dive, "ada/send", 2, 20, i);
  const auto got = heard(dive, "bob/modem", 1.0);
  ASSERT_EQ(got.size(), 1u);
  EXPECT_EQ(got[0].words[0], 0u);
  EXPECT_EQ(dive.state().modems()[0].counts.refused, ModemQueue::kMost - 1);
  EXPECT_EQ(dive.simulation->inputs().modems()[0].crowded_out, 500 - ModemQueue::kMost);
  say(dive, "ada/send", 2, 20, 501);
  EXPECT_EQ(heard(dive, "bob/modem", 1.0).at(0).words[0], 501u);
}

TEST(SceneModem, AUsblRangesByTheTravelThereAndBack) {
  const std::string ranging =
      "modem = { fading = false, usbl = { target = \"bob\", interval_s = 2, range_noise_m = 0, "
      "direction_noise_deg = 0 } }\n";
  TestDive dive = two(two_text(400.0, ranging));
  dive.run(1.9);
  const rov::UsblReading fix = dive.state().modem_tasks()[0].fix.value;
  EXPECT_EQ(dive.state().modem_tasks()[0].fix.count, 1u);
  EXPECT_EQ(fix.heard, 1u);
  EXPECT_NEAR(fix.range_m, 400.0, 0.02);
  EXPECT_NEAR(fix.travel_s, 800.0 / 1489.90, 1e-4);
  EXPECT_NEAR(fix.bearing_rad, 0.0, 1e-3);
  EXPECT_NEAR(fix.position_ned_m.x, 400.0, 0.05);
  // A sound speed that is 1 % off makes a range that is.
  const std::string wrong = ranging.substr(0, ranging.size() - 5) + ", sound_m_s = 1504.8 } }\n";
  TestDive off = two(two_text(400.0, wrong));
  off.run(1.9);
  EXPECT_NEAR(off.state().modem_tasks()[0].fix.value.range_m, 404.0, 0.05);
}

// A ship that sails north at 20 m/s, a buoy on it, and an ROV that stays at the origin.
std::string sailing_text(const std::string& beacon_inputs, const std::string& rov_modem) {
  return std::string(kStillWater) +
         "[[objects]]\nname = \"ship\"\nshape = \"box\"\nsize_m = [1, 1, 1]\ncollision = false\n"
         "track = { waypoints_m = [[0, -6, -100], [0, -6, -2100]], speed_m_s = 20 }\n"
         "[[objects]]\nname = \"beacon\"\nshape = \"box\"\nsize_m = [0.1, 0.1, 0.1]\n"
         "collision = false\non = \"ship\"\nposition_m = [0, 0, -40]\ninputs = " +
         beacon_inputs + "\nmodem = { fading = false }\n" +
         rov_text("position_m = [0, -6, 0]\n" + rov_modem, "ada");
}

// Its own track or carrier has an object under the autopilot, and while its source is not heard.
TEST(SceneModem, AModemIsWhereItsObjectsTrackOrCarrierHasIt) {
  const std::string ranging =
      "modem = { fading = false, usbl = { target = \"beacon\", interval_s = 4, range_noise_m = 0, "
      "direction_noise_deg = 0 } }\n";
  for (const char* inputs :
       {"{ pose = \"autopilot\" }", "{ pose = { from = \"tracker\", then = \"autopilot\" } }"}) {
    TestDive dive = two(sailing_text(inputs, ranging));
    for (const double asked_s : {0.0, 4.0, 8.0}) {
      dive.run(asked_s + 3.9 - dive.time_s());
      const auto& fix = dive.state().modem_tasks()[1].fix;
      ASSERT_EQ(fix.value.heard, 1u) << inputs;
      // The ship sails on while the request comes after it, and for the turnaround of 0.5 s.
      const double there_s = (140.0 + 20.0 * asked_s) / (1489.90 - 20.0);
      const double back_s = (140.0 + 20.0 * (asked_s + there_s + 0.5)) / 1489.90;
      EXPECT_NEAR(fix.value.travel_s, there_s + back_s, 1e-3) << inputs;
      EXPECT_NEAR(fix.value.range_m, 0.5 * (there_s + back_s) * 1489.90, 0.5) << inputs;
      EXPECT_NEAR(fix.value.bearing_rad, 0.0, 1e-3) << inputs;
    }
    // Both ways: what the beacon sends comes from there.
    const double from_m = 140.0 + 20.0 * dive.time_s();
    say(dive, "beacon/send", 2, 4);
    const auto got = heard(dive, "ada/modem", 2.0);
    const auto message = std::ranges::find(got, ModemKind::kMessage, &ModemReading::kind);
    ASSERT_NE(message, got.end()) << inputs;
    EXPECT_NEAR(message->heard_s - message->sent_s, from_m / 1489.90, 1e-3) << inputs;
  }
}

TEST(SceneModem, OutOfReachARangeIsNotHeard) {
  TestDive dive = two(two_text(
      400.0, "modem = { source_level_db = 60, usbl = { target = \"bob\", interval_s = 1 } }\n"));
  dive.run(1.5);
  EXPECT_EQ(dive.state().modem_tasks()[0].fix.count, 1u);
  EXPECT_EQ(dive.state().modem_tasks()[0].fix.value.heard, 0u);
  EXPECT_EQ(dive.state().modems()[1].counts.too_weak, 2u);
}

// Those of one that ranges bob, its noise off.
std::string ranging(const std::string& keys, const std::string& more = {}) {
  return "modem = { fading = false" + more +
         ", usbl = { target = \"bob\", range_noise_m = 0, direction_noise_deg = 0" + keys +
         " } }\n";
}

// 300 m there and back, and half a second between: an answer is whole 0.98 s after the request.
TEST(SceneModem, AUsblThatAsksOftenWaitsForAnswersAsLongAsItIsTold) {
  TestDive impatient = two(two_text(300.0, ranging(", interval_s = 0.8")));
  TestDive patient = two(two_text(300.0, ranging(", interval_s = 0.4, wait_s = 1.2")));
  for (TestDive* dive : {&impatient, &patient}) dive->run(8.2);
  EXPECT_EQ(impatient.state().modem_tasks()[0].fixes, 0u);
  EXPECT_EQ(impatient.state().modem_tasks()[0].misses, 10u);
  const ModemTasks& tasks = patient.state().modem_tasks()[0];
  EXPECT_EQ(tasks.misses, 0u);
  EXPECT_EQ(tasks.fixes, 19u);  // of 21 requests, two of which have not come back
  EXPECT_EQ(tasks.fix.count, 19u);
  EXPECT_NEAR(tasks.fix.value.range_m, 300.0, 0.02);
}

// eve, 30 m east of ada, asks while bob still owes ada an answer.
TEST(SceneModem, AModemAnswersEachOfSeveralThatAskIt) {
  const std::string eve =
      rov_text("position_m = [30, -6, 0]\n" + ranging(", offset_s = 0.2"), "eve");
  TestDive dive = two(two_text(400.0, ranging("")) + eve);
  dive.run(9.9);
  for (const std::size_t modem : {0u, 2u}) {
    const ModemTasks& tasks = dive.state().modem_tasks()[modem];
    EXPECT_EQ(tasks.fixes, 5u) << modem;
    EXPECT_EQ(tasks.misses, 0u) << modem;
  }
  EXPECT_NEAR(dive.state().modem_tasks()[2].fix.value.bearing_rad, std::atan2(-30.0, 400.0), 1e-3);
  EXPECT_EQ(dive.state().modem_tasks()[1].unanswered, 0u);
  // At the same instants their requests collide at bob, which is told before.
  const std::string together =
      two_text(400.0, ranging("")) + rov_text("position_m = [30, -6, 0]\n" + ranging(""), "eve");
  TestDive lost = two(together);
  lost.run(9.9);
  EXPECT_EQ(lost.state().modem_tasks()[0].fixes + lost.state().modem_tasks()[2].fixes, 0u);
  EXPECT_EQ(lost.state().modem_tasks()[0].misses, 4u);
  const auto told = cannot_hold(*lost.world);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_NE(told[0].find("ada, eve: usbl: both ask at the same instants"), std::string::npos)
      << told[0];
}

TEST(SceneModem, TheFirstRequestLeavesAtItsOffset) {
  TestDive dive = two(two_text(400.0, ranging(", offset_s = 0.7")));
  dive.run(0.69);
  EXPECT_EQ(dive.state().modems()[0].counts.sent, 0u);
  dive.run(0.1);
  EXPECT_EQ(dive.state().modems()[0].counts.sent, 1u);
  dive.run(1.8);
  EXPECT_EQ(dive.state().modems()[0].counts.sent, 1u);
  dive.run(0.2);
  EXPECT_EQ(dive.state().modems()[0].counts.sent, 2u);
}

// The turnaround is the request's own duration, so that the answer is due in the very step in which
// the request is whole; also where it comes back before the next one.
TEST(SceneModem, AnAnswerLeavesAtItsInstantWithinAStep) {
  for (const double north_m : {400.0, 3.0}) {
    std::string text = two_text(north_m, ranging(""));
    const std::string modem = "modem = { fading = false }";
    text.replace(text.rfind(modem), modem.size(),
                 "modem = { fading = false, turnaround_s = 0.066 }");
    TestDive dive = two(text);
    dive.run(1.9);
    const auto& fix = dive.state().modem_tasks()[0].fix;
    ASSERT_EQ(fix.value.heard, 1u);
    EXPECT_NEAR(fix.value.range_m, north_m, 0.01);
    EXPECT_NEAR(fix.value.travel_s, 2.0 * north_m / 1489.90, 1e-5);
  }
}

// A ship 100 m north of ada that sails east at 20 m/s: the direction is that of the beacon as its
// answer left, not of where it is as the answer's last bit comes.
TEST(SceneModem, TheDirectionIsThatFromWhichTheAnswerComes) {
  std::string text = sailing_text(
      "{ pose = \"autopilot\" }",
      "modem = { fading = false, usbl = { target = \"beacon\", interval_s = 4, range_noise_m = 0, "
      "direction_noise_deg = 0 } }\n");
  const std::string north = "[[0, -6, -100], [0, -6, -2100]]";
  text.replace(text.find(north), north.size(), "[[0, -6, -60], [2000, -6, -60]]");
  TestDive dive = two(text);
  dive.run(3.9);
  const auto& fix = dive.state().modem_tasks()[1].fix;
  ASSERT_EQ(fix.value.heard, 1u);
  // The box faces along its track, so that the beacon is 40 m ahead of the ship.
  const auto beacon = [](double time_s) { return Vec3(60.0, 40.0 + 20.0 * time_s, 6.0); };
  const double there_s = glm::length(beacon(0.0) - Vec3(0, 0, 6)) / 1489.90;
  const Vec3 left = beacon(there_s + 0.5);
  EXPECT_NEAR(fix.value.bearing_rad, std::atan2(left.y, left.x), 2e-4);
  const Vec3 later = beacon(fix.time_s);
  EXPECT_GT(std::atan2(later.y, later.x) - fix.value.bearing_rad, 5e-3);
}

TEST(SceneModem, WhatGivesNoFixAtTheStartIsToldBefore) {
  const auto told = [](const std::string& text) {
    std::string out;
    for (const std::string& line : cannot_hold(*two(text).world)) out += line + "\n";
    return out;
  };
  EXPECT_EQ(told(two_text(300.0, ranging(""))), "");
  EXPECT_NE(told(two_text(300.0, ranging(", interval_s = 0.8")))
                .find("ada: usbl: at the start, 300 m apart, bob's answer comes 0.985 s after"),
            std::string::npos)
      << told(two_text(300.0, ranging(", interval_s = 0.8")));
  EXPECT_NE(
      told(two_text(300.0, ranging("", ", source_level_db = 60"))).find("request reaches bob"),
      std::string::npos);
  EXPECT_NE(told(two_text(300.0, ranging("", ", self_noise_db = 150")))
                .find("answer comes from bob with"),
            std::string::npos);
  std::string above = two_text(300.0, ranging(""));
  above.replace(above.find("[0, -6, -300]"), 13, "[0, 2, -300]");
  EXPECT_NE(told(above).find("bob's modem is 2 m above the surface"), std::string::npos);
}

TEST(SceneModem, AMessageToItselfIsRefused) {
  TestDive dive = two(two_text(300.0));
  say(dive, "ada/send", 1, 4);
  const auto got = heard(dive, "ada/modem", 0.2);
  ASSERT_EQ(got.size(), 1u);
  EXPECT_EQ(got[0].event, ModemEvent::kRefused);
}

TEST(SceneModem, ARunIsRepeatedBitForBitAndGoesOnFromASavedState) {
  const std::string text = two_text(700.0, "modem = { usbl = { target = \"bob\" } }\n",
                                    "[acoustics]\nspreading = 1.5\n");
  TestDive dive = two(text), again = two(text);
  for (TestDive* one : {&dive, &again})
    for (int i = 0; i < 8; ++i) {
      say(*one, i % 2 ? "ada/send" : "bob/send", 0, 8);
      one->run(0.6);
    }
  EXPECT_EQ(dive.simulation->newest().hash, again.simulation->newest().hash);
  const auto replayed =
      replay_run(*dive.world, recorded_run(*dive.world, *dive.simulation), "modems");
  ASSERT_TRUE(replayed.ok());
  EXPECT_FALSE(replayed->first_difference);
  // In the middle of messages that are on their way.
  say(dive, "ada/send", 2, 40);
  dive.run(0.2);
  const StateFormat format = dive.world->state_format();
  const auto bytes = encode_state(format, saved_state(*dive.simulation, format));
  const auto saved = parse_state(format, bytes, "state");
  ASSERT_TRUE(saved.ok()) << saved.error().message;
  TestDive on = two(text);
  restore_state(*on.simulation, *saved);
  dive.run(2.0), on.run(2.0);
  EXPECT_EQ(dive.simulation->newest().hash, on.simulation->newest().hash);
  EXPECT_GT(dive.state().modems()[1].counts.received, 0u);
}

TEST(SceneModem, WithoutModemsTheHashIsAsItWas) {
  TestDive dive = dive_of(load_text(kStillWater + rov_text("position_m = [0, -6, 0]\n")).value());
  EXPECT_TRUE(dive.state().modems().empty());
  EXPECT_EQ(dive.state().hashed_counts().size(), 3u);
}

TEST(SceneModem, WrongKeysAreRefusedInOneLine) {
  const auto refused = [](const std::string& text) {
    const auto scene = load_text(text);
    if (!scene.ok()) return scene.error().message;
    const auto world = PhysicsWorld::create(*scene);
    EXPECT_FALSE(world.ok());
    return world.ok() ? std::string() : world.error().message;
  };
  EXPECT_NE(refused(two_text(9.0, "modem = { bit_rate = 5 }\n")).find("bit_rate_hz"),
            std::string::npos);
  EXPECT_NE(refused(two_text(9.0, "modem = { bandwidth_hz = 90000 }\n")).find("50000"),
            std::string::npos);
  EXPECT_NE(refused(two_text(9.0, "modem = { usbl = { target = \"eve\" } }\n"))
                .find("found 'eve'; accepted: bob"),
            std::string::npos);
  EXPECT_NE(refused(two_text(9.0, ranging(", wait_s = 31"))).find("15 times the interval, 30 s"),
            std::string::npos);
  // What never gives a fix, at any range.
  EXPECT_NE(refused(two_text(9.0, ranging(", interval_s = 0.58")))
                .find("modem.usbl.interval_s: found 0.58; accepted: more than 0.582, bob's"),
            std::string::npos);
  EXPECT_NE(refused(two_text(9.0, ranging(", wait_s = 0.5"))).find("usbl.wait_s: found 0.5"),
            std::string::npos);
  EXPECT_NE(refused(two_text(9.0, ranging(", interval_s = 0.14, wait_s = 1")))
                .find("accepted: more than 0.148, its request and bob's answer"),
            std::string::npos);
  EXPECT_NE(refused(two_text(9.0, ranging("", ", frequency_hz = 60e3")))
                .find("found 60000, 8000 wide; accepted: a band that bob hears: 25000"),
            std::string::npos);
  EXPECT_NE(refused(std::string(kStillWater) + rov_text("") +
                    "[[objects]]\nname = \"rock\"\nshape = \"box\"\nmodem = {}\n")
                .find("dynamics, human or inputs"),
            std::string::npos);
  EXPECT_NE(refused(two_text(9.0, "modem = {}\n", "[acoustics]\npath = \"bent\"\n"))
                .find("without a profile"),
            std::string::npos);
}

}  // namespace
}  // namespace neritic::testbed
