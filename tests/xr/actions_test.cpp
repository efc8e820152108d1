// Named actions: what a table makes of the state of keyboard, mouse and gamepad.
#include "engine/xr/actions.hpp"

#include <gtest/gtest.h>

#include <set>

namespace neritic::xr {
namespace {

enum Act { kAside, kJump, kLook, kSpeed };

ActionTable table() {
  const std::vector<ActionDesc> actions{
      {"aside", ActionKind::kAxis, {"-key A", "key D", "pad left_x"}, ""},
      {"jump", ActionKind::kPress, {"key Space", "pad a"}, ""},
      {"look", ActionKind::kMotion, {"mouse x while mouse right"}, ""},
      {"speed", ActionKind::kMotion, {"mouse wheel"}, ""}};
  return ActionTable::create(actions).value();
}

std::size_t id(const char* control) {
  return control_id(control).value();
}

TEST(Actions, HeldKeysAndASticksAxisAddUpToOneAtMost) {
  DeviceState state;
  EXPECT_EQ(table().values(state)[kAside], 0.0);
  state.value[id("key A")] = 1.0;
  EXPECT_EQ(table().values(state)[kAside], -1.0);
  state.value[id("key D")] = 1.0;
  EXPECT_EQ(table().values(state)[kAside], 0.0);
  state.value[id("pad left_x")] = 0.25;
  EXPECT_EQ(table().values(state)[kAside], 0.25);
  state.value[id("key A")] = 0.0;
  EXPECT_EQ(table().values(state)[kAside], 1.0);
}

TEST(Actions, EachPressCountsAlsoThoseBetweenTwoFrames) {
  DeviceState state;
  state.value[id("key Space")] = 1.0;  // held, not pressed anew
  EXPECT_EQ(table().values(state)[kJump], 0.0);
  state.presses[id("key Space")] = 2;
  state.presses[id("pad a")] = 1;
  EXPECT_EQ(table().values(state)[kJump], 3.0);
}

TEST(Actions, MotionCountsOnlyWhileTheOtherControlIsHeld) {
  DeviceState state;
  state.value[id("mouse x")] = 40.0;
  EXPECT_EQ(table().values(state)[kLook], 0.0);
  EXPECT_FALSE(table().drags(state));
  state.value[id("mouse right")] = 1.0;
  EXPECT_EQ(table().values(state)[kLook], 40.0);
  EXPECT_TRUE(table().drags(state));
}

TEST(Actions, DevicesThatPanelsUseDoNothingElse) {
  DeviceState state;
  state.value[id("key D")] = state.value[id("pad left_x")] = 0.5;
  state.value[id("mouse wheel")] = 3.0;
  EXPECT_EQ(table().values(state, {.keys = true})[kAside], 0.5);  // the gamepad's
  EXPECT_EQ(table().values(state, {.keys = true})[kSpeed], 3.0);
  EXPECT_EQ(table().values(state, {.mouse = true})[kSpeed], 0.0);
}

TEST(Actions, ADisplayWithoutInputGivesZeros) {
  EXPECT_EQ(ActionValues()[kSpeed], 0.0);
}

TEST(Actions, AnUnknownControlIsRefusedByActionAndNameWithTheKnownOnes) {
  const auto refusal = [](const char* binding) {
    const std::vector<ActionDesc> actions{{"dance", ActionKind::kPress, {binding}, ""}};
    const auto made = ActionTable::create(actions);
    return made.ok() ? std::string() : made.error().message;
  };
  EXPECT_NE(refusal("key Ctrl")
                .find("action dance: found control 'key Ctrl'; accepted: key with one of A B"),
            std::string::npos)
      << refusal("key Ctrl");
  EXPECT_NE(
      refusal("foot left").find("found control 'foot left'; accepted: one of key, mouse, pad"),
      std::string::npos)
      << refusal("foot left");
  EXPECT_NE(refusal("mouse x while mouse nose").find("mouse nose"), std::string::npos);
  EXPECT_EQ(refusal("key LeftShift while mouse left"), "");
}

TEST(Actions, ABindingThatCanNeverActIsRefused) {
  const auto refusal = [](ActionKind kind, const char* binding) {
    const std::vector<ActionDesc> actions{{"dance", kind, {binding}, ""}};
    const auto made = ActionTable::create(actions);
    return made.ok() ? std::string() : made.error().message;
  };
  EXPECT_EQ(
      refusal(ActionKind::kPress, "mouse x"),
      "action dance: found 'mouse x', which moves and is never pressed; accepted: keys, buttons");
  EXPECT_NE(refusal(ActionKind::kAxis, "mouse wheel").find("moves and is never held"),
            std::string::npos);
  EXPECT_NE(refusal(ActionKind::kMotion, "key W").find("is held and does not move"),
            std::string::npos);
  EXPECT_EQ(
      refusal(ActionKind::kPress, "-key I"),
      "action dance: found '-key I', which is pressed and has no direction; accepted: 'key I'");
  EXPECT_EQ(refusal(ActionKind::kPress, "key I"), "");
  EXPECT_EQ(refusal(ActionKind::kMotion, "-mouse wheel"), "");
  EXPECT_EQ(refusal(ActionKind::kAxis, "-pad left_x"), "");
}

TEST(Actions, AControlHasOneActionUnlessItIsASticks) {
  const auto refusal = [](const std::vector<ActionDesc>& actions) {
    const auto made = ActionTable::create(actions);
    return made.ok() ? std::string() : made.error().message;
  };
  const auto press = ActionKind::kPress, axis = ActionKind::kAxis;
  EXPECT_NE(refusal({{"ahead", axis, {"-key W"}, ""}, {"quit", press, {"key Q", "key W"}, ""}})
                .find("action quit: found key W, which is also that of ahead"),
            std::string::npos);
  EXPECT_NE(refusal({{"map", press, {"key M"}, ""}, {"quit", press, {"key M while key A"}, ""}})
                .find("action quit: found key M"),
            std::string::npos);
  EXPECT_NE(refusal({{"ahead", axis, {"-key W", "key W"}, ""}}).find("found key W twice"),
            std::string::npos);
  EXPECT_EQ(refusal({{"turn", axis, {"pad right_x"}, ""}, {"look", axis, {"pad right_x"}, ""}}),
            "");
  EXPECT_EQ(refusal({{"map", press, {"key M while key A"}, ""},
                     {"quit", press, {"key M while key B"}, ""}}),
            "");
}

TEST(Actions, EveryControlHasANameOfItsOwn) {
  std::set<std::string> names;
  for (const Control& control : controls()) names.insert(control.device + " " + control.name);
  EXPECT_EQ(names.size(), controls().size());
  EXPECT_GT(names.size(), 60u);
  EXPECT_LE(names.size(), kMaxControls);
}

}  // namespace
}  // namespace neritic::xr
