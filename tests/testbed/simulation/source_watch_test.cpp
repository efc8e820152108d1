// The lines that tell an operator who has the authority over a group.
#include "testbed/record/source_watch.hpp"

#include "testbed/samples/authority_words.hpp"
#include "tests/testbed/simulation/devices.hpp"

namespace neritic::testbed {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(SourceWatch, TellsOnceOfASourceThatFallsSilentComesBackAndIsReplaced) {
  TestDive dive = dive_of(
      hover_text("body = { from = \"suit\", hold_s = 0.25, then = \"nobody\" }, gas = \"noise\""));
  Device suit(dive, "suit", "diver/joints"), buttons(dive, "controllers", "diver/buttons"),
      events(dive, "operator", "diver/event");
  std::vector<std::string> lines;
  SourceWatch watch(*dive.world, dive.simulation->inbox(),
                    [&](const std::string& line) { lines.push_back(line); });
  const auto run = [&](double seconds) {
    lines.clear();
    dive.run(seconds, [&] { ASSERT_TRUE(watch.accept(dive.simulation->newest(), {}).ok()); });
  };
  run(0.5);
  EXPECT_THAT(lines, IsEmpty());  // what the scene asks for, and nobody was heard yet
  suit.say(BodyJoints{});
  run(0.5);
  EXPECT_THAT(lines, ElementsAre("0.50 s: diver: body: live from suit",
                                 "0.76 s: diver: body: suit is silent, nobody acts"));
  suit.say(BodyJoints{});
  buttons.say(JacketButtons{1});
  run(0.1);
  EXPECT_THAT(lines, ElementsAre("1.00 s: diver: body: suit is heard again"));
  const auto sources = dive.simulation->inbox().source_names();
  EXPECT_EQ(trouble_words(group(dive, DiverGroup::kButtons), sources),
            "1 sample of controllers not used, autopilot");
  events.say(Event{EventKind::kSetAuthority, static_cast<std::uint64_t>(DiverGroup::kButtons),
                   static_cast<std::uint64_t>(Authority::kLive), buttons.source, 0.5});
  run(0.1);
  EXPECT_THAT(lines,
              ElementsAre("1.10 s: diver: buttons: controllers was never heard, autopilot acts"));
  // The line of the state names the source of now, not the scene's.
  std::vector<std::string> told;
  add_trouble<DiverGroup>("diver", dive.state().humans()[0].groups, sources, told);
  EXPECT_THAT(told, ElementsAre("diver: buttons: controllers was never heard, autopilot acts; "
                                "1 sample of controllers not used, live from controllers",
                                "diver: gas: noise was never heard, autopilot acts"));
}

}  // namespace
}  // namespace neritic::testbed
