#include "engine/sim/block.hpp"

#include <gtest/gtest.h>

#include "engine/sim/simulation.hpp"
#include "tests/sim/spring.hpp"

namespace neritic::sim {
namespace {

struct Boat {
  double speed_m_s = 2.5;
  Vec3 at_m{0.0};
  static void fields(auto&& field, auto& self) {
    field("speed_m_s", self.speed_m_s);
    field("at_m", self.at_m);
  }
};
struct Buoy {
  std::uint64_t number = 7;
  static void fields(auto&& field, auto& self) { field("number", self.number); }
};

class Fleet : public Block<Boat, Buoy> {
 public:
  Fleet() = default;
  Fleet(std::size_t boats, std::size_t buoys) : Block({boats, buoys}) {}
  std::span<Boat> boats() { return part<Boat>(); }
  std::span<const Boat> boats() const { return part<Boat>(); }
  std::span<Buoy> buoys() { return part<Buoy>(); }
  std::span<const Buoy> buoys() const { return part<Buoy>(); }
  static void fields(auto&& field, auto& self) {
    auto boats = self.boats();
    auto buoys = self.buoys();
    field("boats", boats);
    field("buoys", buoys);
  }
};

struct Uncounted : Block<Buoy> {
  explicit Uncounted(const Counts& counts) : Block(counts) {}
  static void fields(auto&&, auto&) {}
};

TEST(Block, HoldsWhatItsCountsSayAndNoMore) {
  const Fleet fleet(3, 5);
  ASSERT_EQ(fleet.boats().size(), 3u);
  ASSERT_EQ(fleet.buoys().size(), 5u);
  for (const Boat& boat : fleet.boats()) EXPECT_EQ(boat.speed_m_s, 2.5);
  for (const Buoy& buoy : fleet.buoys()) EXPECT_EQ(buoy.number, 7u);
  EXPECT_EQ(fleet.bytes().size(), 3 * sizeof(Boat) + 5 * sizeof(Buoy));
  EXPECT_EQ(Fleet().bytes().size(), 0u);
  EXPECT_EQ(Fleet(0, 2).bytes().size(), 2 * sizeof(Buoy));
  check_fields_cover(fleet);
  std::vector<std::string> names;
  const Fleet small(1, 2);
  for_each_named_scalar(small, [&](const std::string& name, auto&) { names.push_back(name); });
  EXPECT_EQ(names,
            (std::vector<std::string>{"boats.0.speed_m_s", "boats.0.at_m.x", "boats.0.at_m.y",
                                      "boats.0.at_m.z", "buoys.0.number", "buoys.1.number"}));
}

TEST(Block, ItemsAreApartAndCopiesAreWhole) {
  Fleet fleet(2, 2);
  fleet.boats()[1].at_m = Vec3(1.0, 2.0, 3.0);
  fleet.buoys()[0].number = 1;
  fleet.buoys()[1].number = 2;
  const Fleet copy = fleet;
  EXPECT_TRUE(same_bits(fleet, copy));
  fleet.buoys()[1].number = 3;
  EXPECT_FALSE(same_bits(fleet, copy));
  EXPECT_EQ(copy.boats()[1].at_m.y, 2.0);
  EXPECT_EQ(copy.buoys()[1].number, 2u);
  EXPECT_EQ(fleet.boats()[0].speed_m_s, 2.5);
}

TEST(Block, AssigningTheSameCountsKeepsMemoryAndReferences) {
  Fleet fleet(2, 1);
  const Boat& boat = fleet.boats()[1];
  Fleet other(2, 1);
  other.boats()[1].speed_m_s = 9.0;
  fleet = other;
  EXPECT_EQ(&boat, &fleet.boats()[1]);
  EXPECT_EQ(boat.speed_m_s, 9.0);
  fleet = Fleet(2, 1);
  EXPECT_EQ(&boat, &fleet.boats()[1]);
  fleet = Fleet(1, 4);
  EXPECT_EQ(fleet.buoys().size(), 4u);
}

TEST(Block, ItsHashSaysHowManyThereAre) {
  // Uncounted lists no fields: only the counts differ.
  EXPECT_NE(state_hash(Uncounted({1})), state_hash(Uncounted({2})));
  EXPECT_EQ(state_hash(Uncounted({2})), state_hash(Uncounted({2})));
  EXPECT_NE(state_hash(Fleet(1, 1)), state_hash(Fleet(1, 2)));
  EXPECT_NE(state_hash(1, Fleet(1, 1)), state_hash(2, Fleet(1, 1)));
}

// Lock-step, a refused step and a snapshot, of a block as of a plain struct.
TEST(Block, IsAStateThatSteps) {
  Simulation<Fleet, Buoy, test::PlainInbox<Buoy>> simulation(
      {.step_s = 0.5}, Fleet(3, 1), {}, std::make_unique<test::PlainInbox<Buoy>>(),
      [](const Fleet& before, const Buoy& inputs, const StepTime& time, Fleet& after) {
        after = before;
        for (Boat& boat : after.boats()) boat.at_m.x += boat.speed_m_s * time.step_s;
        after.buoys()[0].number = time.step;
        if (inputs.number == 0) after.boats()[2].at_m.y = std::nan("");
      },
      [](Buoy& inputs, const Buoy& message, std::uint64_t) { inputs = message; });
  auto reader = simulation.reader();
  simulation.advance(4);
  ASSERT_TRUE(reader.update());
  EXPECT_EQ(reader.newest().state.boats()[2].at_m.x, 5.0);
  EXPECT_EQ(reader.previous().state.boats()[2].at_m.x, 3.75);
  EXPECT_EQ(reader.newest().state.buoys()[0].number, 3u);
  simulation.inbox().push({0});
  simulation.advance(1);
  EXPECT_EQ(simulation.refused_states(), 1u);
  EXPECT_EQ(simulation.newest().state.boats()[0].at_m.x, 5.0);
  EXPECT_EQ(simulation.newest().step, 5u);
}

}  // namespace
}  // namespace neritic::sim
