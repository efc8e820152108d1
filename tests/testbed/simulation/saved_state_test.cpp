// A saved state goes on with the hashes of the run that it was taken from, and a state that does
// not belong is refused in one line.
#include "testbed/simulation/saved_state.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <optional>

#include "engine/core/random.hpp"
#include "engine/core/source_name.hpp"
#include "tests/testbed/simulation/senders.hpp"

namespace neritic::testbed {
namespace {

// A mission, a wall to touch, sensors, a diver who swims by a plan; current.
std::string saved_scene(const std::string& rov_keys = "") {
  return std::string(R"(seed = 5
[physics]
[current]
kind = "uniform"
velocity_m_s = [0.2, 0, 0.1]
[[objects]]
name = "wall"
class = "structure"
shape = "box"
size_m = [6, 4, 0.5]
position_m = [0, -10, -1.5]
)") +
         rov_text("position_m = [0, -10, 0]\n" + rov_keys + R"(
mission = { waypoints = [ { position_m = [0, -10, -4] }, { position_m = [2, -8, 1] } ] }
)",
                  "rov", "bluerov2_heavy_survey_dynamics.toml") +
         rov_text("position_m = [3, -9, 1]\n", "adrift") +
         diver_text(std::string("position_m = [-3, -10, 0]\n") + kProne +
                    "swim = { waypoints_m = [[-3, -10, -6], [0, -9, -6]] }\n");
}

// A pilot and a suit change the inputs now and then.
void push_some(const TestDive& dive, std::uint64_t step) {
  if (step % 97 != 0) return;
  Piloting piloting{.piloted = step / 97 % 2};
  piloting.pilot[0] = 10.0;
  pilot(dive, 1, piloting);
}

// 1 000 steps of a run, each restored from bytes in another simulation, of a world built anew, that
// then takes 12 steps.
TEST(SavedState, GoesOnWithTheSameHashesFromAThousandRandomPlaces) {
  constexpr std::uint64_t kSteps = 2400, kPlaces = 1000, kOn = 12;
  TestDive run = dive_of(saved_scene());
  const TestDive other = dive_of(saved_scene());
  std::vector<std::uint64_t> places;
  for (std::uint64_t i = 0; places.size() < kPlaces; ++i) {
    const std::uint64_t place = random_bits({3, 1, 4}, i) % kSteps;
    if (std::ranges::find(places, place) == places.end()) places.push_back(place);
  }
  std::vector<std::vector<std::byte>> saved(kSteps);
  const StateFormat format = run.world->state_format();
  for (std::uint64_t step = 0; step < kSteps + kOn; ++step) {
    if (std::ranges::find(places, step) != places.end())
      saved[step] = encode_state(format, saved_state(*run.simulation, run.world->state_format()));
    push_some(run, step);
    run.simulation->advance(1);
  }
  const auto& hashes = run.simulation->log().hashes;
  const StateFormat other_format = other.world->state_format();
  for (const std::uint64_t place : places) {
    const auto restored = parse_state(other_format, saved[place], "dive.state");
    ASSERT_TRUE(restored.ok()) << restored.error().message;
    restore_state(*other.simulation, *restored);
    ASSERT_EQ(other.simulation->newest().hash, hashes[place]) << place;
    for (std::uint64_t i = 0; i < kOn; ++i) {
      push_some(other, place + i);
      other.simulation->advance(1);
      ASSERT_EQ(other.simulation->newest().hash, hashes[place + i + 1]) << place << " + " << i + 1;
    }
  }
  EXPECT_GT(run.vehicle(0).contact.touched_steps + run.vehicle(1).contact.touched_steps, 0u);
}

// The second process is this program anew, which finds the folder named and dives no first dive.
TEST(SavedState, GoesOnInAnotherProcessFromAThousandRandomPlaces) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  constexpr const char* kFolder = "NERITIC_TEST_STATES";
  constexpr std::uint64_t kSteps = 1200, kPlaces = 1000, kOn = 60;
  const auto place = [](std::uint64_t i) { return random_bits({2, 7, 1}, i) % kSteps; };
  std::optional<test::ScratchFolder> scratch;
  if (std::getenv(kFolder) == nullptr) {
    scratch.emplace();
    TestDive run = dive_of(saved_scene());
    for (std::uint64_t step = 0; step < kSteps + kOn; ++step) {
      for (std::uint64_t i = 0; i < kPlaces; ++i) {
        if (place(i) != step) continue;
        const auto path = scratch->path() / fmt::format("{}.state", i);
        ASSERT_TRUE(write_state(path, run.world->state_format(),
                                saved_state(*run.simulation, run.world->state_format()))
                        .ok());
      }
      push_some(run, step);
      run.simulation->advance(1);
    }
    std::string hashes;
    for (std::uint64_t i = 0; i < kPlaces; ++i)
      hashes += fmt::format("{:016x}\n", run.simulation->log().hashes[place(i) + kOn]);
    ASSERT_TRUE(write_text(scratch->path() / "hashes", hashes).ok());
    ASSERT_EQ(setenv(kFolder, scratch->path().c_str(), 1), 0);
  }
  const auto go_on = [&] {
    const std::filesystem::path folder = std::getenv(kFolder);
    const TestDive dive = dive_of(saved_scene());
    std::string hashes;
    for (std::uint64_t i = 0; i < kPlaces; ++i) {
      restore_state(
          *dive.simulation,
          read_state(folder / fmt::format("{}.state", i), dive.world->state_format()).value());
      for (std::uint64_t step = place(i); step < place(i) + kOn; ++step) {
        push_some(dive, step);
        dive.simulation->advance(1);
      }
      hashes += fmt::format("{:016x}\n", dive.simulation->newest().hash);
    }
    std::exit(hashes == read_text(folder / "hashes").value() ? 0 : 1);
  };
  EXPECT_EXIT(go_on(), testing::ExitedWithCode(0), "");
  unsetenv(kFolder);
}

// A keyboard flies while the state is saved. Where the run goes on, another device comes first.
TEST(SavedState, EachSourceHasItsNumberAgainWhicheverDeviceComesFirst) {
  TestDive run = dive_of(saved_scene());
  const SourceId keyboard = run.simulation->inbox().open("keyboard").value();
  const StreamId events = run.world->streams().find("adrift/event").value();
  constexpr auto kWrench = static_cast<std::size_t>(VehicleGroup::kWrench);
  run.simulation->inbox().push(
      {{events, keyboard, 0, 0, 0}, hand_over(kWrench, Authority::kLive, keyboard)});
  run.simulation->advance(1);
  const StateFormat format = run.world->state_format();
  const auto bytes = encode_state(format, saved_state(*run.simulation, run.world->state_format()));

  const TestDive later = dive_of(saved_scene());
  restore_state(*later.simulation, parse_state(format, bytes, "dive.state").value());
  EXPECT_NE(later.simulation->inbox().open("joystick").value(), keyboard);
  EXPECT_EQ(later.simulation->inbox().open("keyboard").value(), keyboard);
  EXPECT_EQ(later.simulation->inputs().vehicles()[1].control[kWrench].source, keyboard);
}

// A state fits a run of the same scene whose devices came in another order, with other names too:
// it goes on with the hashes of its own run, and the names have the authority, not the numbers.
TEST(SavedState, GoesOnInARunWhoseSourcesHaveOtherNumbers) {
  constexpr auto kWrench = static_cast<std::size_t>(VehicleGroup::kWrench);
  TestDive run = dive_of(saved_scene());
  const auto events = run.world->streams().find("adrift/event").value();
  const auto push = [&](const TestDive& dive, const std::string& name, std::uint64_t sequence,
                        double wrench_n) {
    SampleInbox& inbox = dive.simulation->inbox();
    const SourceId source = inbox.find(name).value();
    const auto now = static_cast<TimeNs>(1e9 * dive.time_s());
    if (sequence == 0) {
      EXPECT_EQ(
          inbox.push({{events, source, 0, now, now}, hand_over(kWrench, Authority::kLive, source)}),
          SampleVerdict::kAccepted);
    }
    VehicleWrench wrench;
    wrench.wrench[0] = wrench_n;
    EXPECT_EQ(inbox.push({{dive.world->streams().find("adrift/wrench").value(), source, sequence,
                           now, now},
                          wrench}),
              SampleVerdict::kAccepted);
  };
  for (const char* name : {"pad", "keyboard"}) ASSERT_TRUE(run.simulation->inbox().open(name).ok());
  push(run, "pad", 0, 5.0), run.simulation->advance(3);
  push(run, "keyboard", 0, 20.0), run.simulation->advance(3);
  const StateFormat format = run.world->state_format();
  const auto saved =
      parse_state(format, encode_state(format, saved_state(*run.simulation, format)), "dive.state");
  ASSERT_TRUE(saved.ok()) << saved.error().message;

  TestDive other = dive_of(saved_scene());
  SampleInbox& inbox = other.simulation->inbox();
  constexpr TimeNs kSlow_ns = 3'000'000'000;
  const SourceId strap = inbox.open("strap", kSlow_ns).value();
  ASSERT_TRUE(inbox.open("joystick").ok());
  const SourceId keyboard = inbox.open("keyboard").value();
  push(other, "keyboard", 0, 7.0), other.simulation->advance(5);
  const auto sources = open_sources(inbox, *saved);
  ASSERT_TRUE(sources.ok()) << sources.error().message;
  restore_state(*other.simulation, *saved, *sources);
  EXPECT_EQ(inbox.find("strap"), strap);
  EXPECT_EQ(inbox.find("keyboard"), keyboard);
  EXPECT_NE(saved->inputs.vehicles()[1].control[kWrench].source, keyboard);
  const GroupControl& control = other.simulation->inputs().vehicles()[1].control[kWrench];
  EXPECT_EQ(control.source, keyboard);
  EXPECT_EQ(other.simulation->newest().hash, run.simulation->newest().hash);
  // Both go on, by the keyboard's next word alone: the pad is not heeded.
  for (std::uint64_t i = 1; i < 20; ++i) {
    for (TestDive* dive : {&run, &other}) {
      push(*dive, "keyboard", i, 20.0 + static_cast<double>(i));
      push(*dive, "pad", i, -50.0);
      dive->simulation->advance(1);
    }
    ASSERT_EQ(other.simulation->newest().hash, run.simulation->newest().hash) << i;
  }
  EXPECT_GT(control.heard, 19u);
  EXPECT_EQ(control.unheeded_source, inbox.find("pad"));
  // A slow device may still be as late as it said.
  const auto gas = other.world->streams().find("diver/heart").value();
  const auto now = static_cast<TimeNs>(1e9 * other.time_s()) + kSlow_ns;
  EXPECT_EQ(inbox.push({{gas, strap, 0, now - kSlow_ns + 1, now}, Heart{}}),
            SampleVerdict::kAccepted);
}

TEST(SavedState, AnInboxWithoutRoomForItsSourcesIsToldInOneLine) {
  TestDive run = dive_of(saved_scene());
  SavedState saved = saved_state(*run.simulation, run.world->state_format());
  saved.sources.push_back("pad");
  SampleInbox& inbox = run.simulation->inbox();
  for (std::size_t i = inbox.source_names().size(); i < SampleInbox::kMaxSources; ++i)
    ASSERT_TRUE(inbox.open(fmt::format("device_{}", i)).ok());
  const auto sources = open_sources(inbox, saved);
  ASSERT_FALSE(sources.ok());
  EXPECT_EQ(sources.error().code, ErrorCode::kBadInput);
  EXPECT_NE(sources.error().message.find("accepted: up to 255"), std::string::npos);
}

TEST(SavedState, NamesThatAreNotThoseOfTheSceneOrComeTwiceAreRefusedInOneLine) {
  TestDive dive = dive_of(saved_scene());
  const StateFormat format = dive.world->state_format();
  const auto refused = [&](std::vector<std::string> sources) {
    SavedState saved = saved_state(*dive.simulation, dive.world->state_format());
    saved.sources = std::move(sources);
    const auto parsed = parse_state(format, encode_state(format, saved), "dive.state");
    return parsed.ok() ? std::string() : parsed.error().message;
  };
  EXPECT_EQ(refused({"simulation", "pad"}), "");
  EXPECT_EQ(refused({}), "dive.state: 0 sources; accepted: 1 to 256");
  EXPECT_EQ(refused({"pad"}),
            "dive.state: source 0: found 'pad'; accepted: 'simulation', as in the scene");
  EXPECT_EQ(refused({"simulation", "pad", "pad"}),
            "dive.state: source 2: found pad again; accepted: each name once");
  for (const char* name : {"", "two\nlines", "two words", "nobody", "simulation"})
    EXPECT_TRUE(refused({"simulation", "pad", name})
                    .ends_with("; accepted: " + std::string(kAcceptedSourceName)))
        << name;
}

std::string refusal(const StateFormat& format, std::span<const std::byte> bytes) {
  const auto parsed = parse_state(format, bytes, "dive.state");
  if (parsed.ok()) return "";
  EXPECT_EQ(parsed.error().code, ErrorCode::kBadInput);
  EXPECT_TRUE(parsed.error().message.starts_with("dive.state: ")) << parsed.error().message;
  EXPECT_EQ(parsed.error().message.find('\n'), std::string::npos);
  return parsed.error().message;
}

TEST(SavedState, OfAnotherSceneOrVersionOrDamagedIsRefusedInOneLine) {
  TestDive dive = dive_of(saved_scene());
  dive.run(0.1);
  const StateFormat format = dive.world->state_format();
  const auto bytes =
      encode_state(format, saved_state(*dive.simulation, dive.world->state_format()));
  ASSERT_EQ(refusal(format, bytes), "");
  const auto has = [](const std::string& message, const char* part) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  has(refusal(dive_of(saved_scene("failed_thrusters = [2]\n")).world->state_format(), bytes),
      "a state of another scene, whose hash is ");
  StateFormat seeded = format;
  ++seeded.seed;
  has(refusal(seeded, bytes),
      fmt::format("a state of seed {}; accepted: one of seed {}", format.seed, seeded.seed)
          .c_str());
  StateFormat fewer = format;
  fewer.state = PhysicsState(1, 1, 1, 1);
  has(refusal(fewer, bytes), "a state of another layout, whose hash is ");
  auto version = bytes;
  version[8] = std::byte{9};
  has(refusal(format, version), "a saved state of version 9; accepted: 7");
  has(refusal(format, {}), "found no saved state; accepted: bytes that begin with NRTCSAVE");
  for (std::size_t size = 0; size < bytes.size(); size += size < 80 ? 1 : 37)
    ASSERT_NE(refusal(format, std::span(bytes).first(size)), "") << size;
  auto longer = bytes;
  longer.push_back(std::byte{0});
  has(refusal(format, longer), "damaged: its bytes have the hash ");
  for (std::size_t at = 0; at < bytes.size(); at += at < 72 ? 1 : 11) {
    auto damaged = bytes;
    damaged[at] ^= std::byte{4};
    ASSERT_NE(refusal(format, damaged), "") << at;
  }
}

// The hash covers what the physics is built from, and no camera.
TEST(SavedState, ACameraMoreIsTheSameSceneAndAnyOtherWaypointOrWallIsNot) {
  const auto hash = [](const std::string& text) {
    return dive_of(text).world->state_format().scene_hash;
  };
  const std::string text = saved_scene();
  const auto changed = [&](const char* from, const char* to) {
    std::string other = text;
    other.replace(other.find(from), std::strlen(from), to);
    return hash(other);
  };
  const std::uint64_t first = hash(text);
  EXPECT_EQ(hash(text), first);
  EXPECT_EQ(hash(text + "[[cameras]]\nname = \"eye\"\nposition_m = [0, -5, 9]\n"), first);
  EXPECT_NE(changed("seed = 5", "seed = 6"), first);
  EXPECT_NE(changed("[0.2, 0, 0.1]", "[0.2, 0, 0.2]"), first);
  EXPECT_NE(changed("size_m = [6, 4, 0.5]", "size_m = [6, 4, 0.6]"), first);
  EXPECT_NE(
      changed("position_m = [3, -9, 1]", "position_m = [3, -9, 1]\ninputs = { wrench = \"pad\" }"),
      first);
  EXPECT_NE(changed("[2, -8, 1]", "[2, -8, 1.1]"), first);
  EXPECT_NE(changed("[0, -9, -6]", "[0, -9, -7]"), first);
}

}  // namespace
}  // namespace neritic::testbed
