#include "testbed/samples/authority.hpp"

#include <gtest/gtest.h>

#include "testbed/samples/group_inputs.hpp"
#include "tests/testbed/samples/streams.hpp"

namespace neritic::testbed {
namespace {

constexpr double kStep_s = 1.0 / 240.0;

GroupControl live(std::uint64_t source, double hold_s, Authority then = Authority::kAutopilot) {
  return {.authority = Authority::kLive, .then = then, .source = source, .hold_s = hold_s};
}

TEST(Authority, AGroupThatIsNotLiveListensToNobody) {
  for (const Authority authority :
       {Authority::kNobody, Authority::kAutopilot, Authority::kRecording}) {
    GroupControl control{.authority = authority};
    EXPECT_FALSE(hear(control, 0, 3));
    EXPECT_EQ(control.unheeded, 1u);
    const GroupState state = next_group({}, control, 4, kStep_s);
    EXPECT_EQ(state.phase, GroupPhase::kChosen);
    EXPECT_EQ(acting(control, state.phase), authority);
  }
}

TEST(Authority, ASilentSourceHoldsThenFallsBackAndIsCountedOnceUntilItComesBack) {
  for (const Authority then : {Authority::kAutopilot, Authority::kNobody}) {
    GroupControl control = live(2, 0.5, then);
    GroupState state = next_group({}, control, 0, kStep_s);
    EXPECT_EQ(state.phase, GroupPhase::kWaiting);
    EXPECT_EQ(acting(control, state.phase), then);
    ASSERT_TRUE(hear(control, 2, 10));
    std::uint64_t lost_at = 0;
    for (std::uint64_t step = 10; step < 400; ++step) {
      state = next_group(state, control, step, kStep_s);
      if (lost_at == 0 && state.phase == GroupPhase::kLost) lost_at = step;
      EXPECT_EQ(acting(control, state.phase), lost_at ? then : Authority::kLive) << step;
    }
    EXPECT_EQ(lost_at, 10u + 121u);  // the first step more than 0.5 s after the sample
    EXPECT_EQ(state.losses, 1u);
    ASSERT_TRUE(hear(control, 2, 400));
    state = next_group(state, control, 400, kStep_s);
    EXPECT_EQ(state.phase, GroupPhase::kLive);
    EXPECT_EQ(state.losses, 1u);
    for (std::uint64_t step = 401; step < 800; ++step)
      state = next_group(state, control, step, kStep_s);
    EXPECT_EQ(state.losses, 2u);
  }
}

TEST(Authority, AnEventHandsAGroupOverAndOthersKeepTheirs) {
  const StreamTable table = diver_and_rov();
  DiverInputs inputs = autopilot_diver();
  const auto buttons = [&](SourceId source, std::uint64_t bits) {
    return apply(inputs, sample_of(table, "diver/buttons", source, 0, JacketButtons{bits}), 7);
  };
  EXPECT_FALSE(buttons(4, 1));  // the autopilot has them
  EXPECT_EQ(inputs.buttons.pressed, 0u);
  const auto hand_over = [&](std::uint64_t group, std::uint64_t authority, std::uint64_t source) {
    const Event event{EventKind::kSetAuthority, group, authority, source};
    return apply(inputs, sample_of(table, "diver/event", 9, 0, event), 7);
  };
  constexpr auto kLive = static_cast<std::uint64_t>(Authority::kLive);
  const auto group = static_cast<std::uint64_t>(DiverGroup::kButtons);
  EXPECT_TRUE(hand_over(group, kLive, 4));
  EXPECT_TRUE(buttons(4, 1));
  EXPECT_FALSE(buttons(5, 2));  // another source
  EXPECT_EQ(inputs.buttons.pressed, 1u);
  EXPECT_EQ(inputs.of(DiverGroup::kButtons).unheeded, 2u);
  EXPECT_EQ(inputs.of(DiverGroup::kBody).authority, Authority::kAutopilot);
  EXPECT_FALSE(hand_over(kDiverGroups, kLive, 4));
  EXPECT_FALSE(hand_over(group, kAuthorities, 4));
  EXPECT_TRUE(buttons(4, 4));
}

TEST(Authority, EveryInputStreamFeedsItsGroupAloneAndOutputsFeedNone) {
  const StreamTable table = diver_and_rov();
  for (StreamId id = 0; id < table.size(); ++id) {
    const Stream& stream = table[id];
    const auto group = group_of(stream.kind);
    if (stream.kind == PayloadKind::kEvent) continue;
    const Sample sample{{id, 1, 0, 0, 0}, empty_payload(stream.kind)};
    const auto check = [&](auto inputs) {
      for (GroupControl& control : inputs.control) control = live(1, 1.0);
      EXPECT_EQ(apply(inputs, sample, 3), group.has_value()) << stream.name;
      for (std::size_t i = 0; i < inputs.control.size(); ++i)
        EXPECT_EQ(inputs.control[i].heard, group == i ? 1u : 0u) << stream.name;
    };
    if (stream.sort == OwnerSort::kDiver)
      check(autopilot_diver());
    else
      check(autopilot_vehicle());
  }
}

// A suit at 240 Hz, a strap at 1 Hz and buttons at 10 Hz on one diver, over a minute of steps.
TEST(Authority, ProducersAtDifferentRatesEachKeepTheirNewestValue) {
  const StreamTable table = diver_and_rov();
  SampleInbox inbox(table, 64);
  DiverInputs inputs = autopilot_diver();
  const SourceId suit = inbox.open("suit").value(), strap = inbox.open("strap").value(),
                 controls = inbox.open("controllers").value();
  inputs.of(DiverGroup::kBody) = live(suit, 0.5);
  inputs.of(DiverGroup::kButtons) = live(controls, 0.5);
  inputs.of(DiverGroup::kHeart) = live(strap, 10.0);
  std::array<GroupState, kDiverGroups> states;
  std::uint64_t beats = 0, presses = 0;
  for (std::uint64_t step = 0; step < 60 * 240; ++step) {
    BodyJoints body;
    body.other_power_w = static_cast<double>(step);
    inbox.push(sample_of(table, "diver/joints", suit, step, body));
    if (step % 24 == 0)
      inbox.push(sample_of(table, "diver/buttons", controls, presses++, JacketButtons{step / 24}));
    if (step % 240 == 0) {
      Heart heart;
      heart.state.beats = step;
      inbox.push(sample_of(table, "diver/heart", strap, beats++, heart));
    }
    for (const Sample& sample : inbox.drain()) ASSERT_TRUE(apply(inputs, sample, step));
    ASSERT_EQ(inputs.body.other_power_w, static_cast<double>(step));
    ASSERT_EQ(inputs.buttons.pressed, step / 24);
    ASSERT_EQ(inputs.heart.state.beats, step / 240 * 240);
    for (std::size_t i = 0; i < kDiverGroups; ++i)
      states[i] = next_group(states[i], inputs.control[i], step, kStep_s);
    for (const DiverGroup group : {DiverGroup::kBody, DiverGroup::kButtons, DiverGroup::kHeart})
      ASSERT_EQ(states[static_cast<std::size_t>(group)].phase, GroupPhase::kLive);
  }
  EXPECT_EQ(inputs.of(DiverGroup::kHeart).heard, 60u);
  EXPECT_EQ(inputs.of(DiverGroup::kButtons).heard, 600u);
  EXPECT_EQ(inputs.of(DiverGroup::kBody).heard, 14400u);
  for (const GroupState& state : states) EXPECT_EQ(state.losses, 0u);
}

TEST(Authority, AnEventGivesAGroupToARecordingOnlyWhereTheSceneHasOne) {
  const StreamTable table = diver_and_rov();
  constexpr auto kRecording = static_cast<std::uint64_t>(Authority::kRecording);
  constexpr auto kBody = static_cast<std::uint64_t>(DiverGroup::kBody);
  constexpr auto kHead = static_cast<std::uint64_t>(DiverGroup::kHead);
  DiverInputs diver = autopilot_diver();
  const auto ask = [&](std::uint64_t group, std::uint64_t recorded) {
    const Event event{EventKind::kSetAuthority, group, kRecording, 0};
    return apply(diver, sample_of(table, "diver/event", 9, 0, event), 7, recorded);
  };
  EXPECT_FALSE(ask(kBody, 0));
  EXPECT_FALSE(ask(kHead, std::uint64_t{1} << kBody));
  EXPECT_EQ(diver.of(DiverGroup::kBody).authority, Authority::kAutopilot);
  EXPECT_EQ(diver.refused_events, 2u);
  EXPECT_TRUE(ask(kBody, std::uint64_t{1} << kBody));
  EXPECT_EQ(diver.of(DiverGroup::kBody).authority, Authority::kRecording);
  VehicleInputs vehicle = autopilot_vehicle();
  const Event event{EventKind::kSetAuthority, 0, kRecording, 0};
  EXPECT_FALSE(apply(vehicle, sample_of(table, "rov/event", 9, 0, event), 7));
  EXPECT_EQ(vehicle.refused_events, 1u);
}

}  // namespace
}  // namespace neritic::testbed
