#include "engine/sim/fields.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "engine/sim/state_hash.hpp"
#include "tests/sim/spring.hpp"

namespace neritic::sim {
namespace {

using test::kNan;

struct Arm {
  double angles_rad[2] = {1.0, 2.0};
  static void fields(auto&& field, auto& self) { field("angles_rad", self.angles_rad); }
};
struct Robot {
  Pose pose;
  std::array<Arm, 2> arms;
  float volts[2] = {16.0f, 15.0f};
  std::int64_t ticks = -3;
  static void fields(auto&& field, auto& self) {
    field("pose", self.pose);
    field("arms", self.arms);
    field("volts", self.volts);
    field("ticks", self.ticks);
  }
};
enum class Mood : std::int64_t { kCalm, kWild };
struct Fish {
  double length_m = 0.2;
  Mood mood = Mood::kWild;
  static void fields(auto&& field, auto& self) {
    field("length_m", self.length_m);
    field("mood", self.mood);
  }
};
struct Forgetful {
  double kept = 0.0, forgotten = 0.0;
  static void fields(auto&& field, auto& self) { field("kept", self.kept); }
};

TEST(Fields, NamesFollowTheNesting) {
  const Robot robot;
  std::vector<std::string> names;
  for_each_named_scalar(robot,
                        [&](const std::string& name, const auto&) { names.push_back(name); });
  EXPECT_EQ(names, (std::vector<std::string>{
                       "pose.position_m.x", "pose.position_m.y", "pose.position_m.z",
                       "pose.rotation.w", "pose.rotation.x", "pose.rotation.y", "pose.rotation.z",
                       "arms.0.angles_rad.0", "arms.0.angles_rad.1", "arms.1.angles_rad.0",
                       "arms.1.angles_rad.1", "volts.0", "volts.1", "ticks"}));
}

TEST(Fields, CoverEveryByteOrStop) {
  check_fields_cover(Robot{});
  EXPECT_DEATH(check_fields_cover(Forgetful{}), "fields name 8 bytes of 16");
}

TEST(Fields, AnEnumIsItsNumber) {
  Fish fish;
  check_fields_cover(fish);
  const std::uint64_t wild = state_hash(fish);
  std::vector<std::string> names;
  for_each_named_scalar(fish, [&](const std::string& name, auto& number) {
    names.push_back(name);
    if (name == "mood") number = 0;
  });
  EXPECT_EQ(names, (std::vector<std::string>{"length_m", "mood"}));
  EXPECT_EQ(fish.mood, Mood::kCalm);
  EXPECT_NE(state_hash(fish), wild);
  for_each_scalar(fish, [](auto& number) { number = 1; });
  EXPECT_EQ(fish.mood, Mood::kWild);
}

TEST(Fields, OneNumberThatIsNotFiniteIsFound) {
  Robot robot;
  EXPECT_TRUE(all_finite(robot));
  robot.volts[1] = std::numeric_limits<float>::infinity();
  EXPECT_FALSE(all_finite(robot));
  robot = {};
  robot.arms[1].angles_rad[0] = kNan;
  EXPECT_FALSE(all_finite(robot));
}

TEST(StateHash, DiffersWithAnyBitOfAnyNumber) {
  const Robot robot;
  const std::uint64_t hash = state_hash(robot);
  for (std::size_t byte = 0; byte < sizeof(Robot); ++byte)
    for (int bit = 0; bit < 8; ++bit) {
      Robot changed = robot;
      reinterpret_cast<unsigned char*>(&changed)[byte] ^= static_cast<unsigned char>(1 << bit);
      const bool only_a_sign_of_zero = all_finite(changed) && [&] {
        bool equal = true;
        std::vector<double> a, b;
        for_each_scalar(robot, [&](const auto& v) { a.push_back(static_cast<double>(v)); });
        for_each_scalar(changed, [&](const auto& v) { b.push_back(static_cast<double>(v)); });
        for (std::size_t i = 0; i < a.size(); ++i) equal = equal && a[i] == b[i];
        return equal;
      }();
      EXPECT_EQ(state_hash(changed) == hash, only_a_sign_of_zero) << byte << " " << bit;
    }
}

TEST(StateHash, ZeroHasNoSignAndNanNoPayload) {
  Robot a, b;
  a.pose.position_m.x = 0.0;
  b.pose.position_m.x = -0.0;
  EXPECT_EQ(state_hash(a), state_hash(b));
  a.pose.position_m.x = kNan;
  b.pose.position_m.x = -std::nan("0x123");
  EXPECT_EQ(state_hash(a), state_hash(b));
  b.volts[0] = -std::numeric_limits<float>::quiet_NaN();
  EXPECT_NE(state_hash(a), state_hash(b));
}

TEST(StateHash, IsTheSameAsEver) {
  // A literal, so that recorded runs stay comparable: whoever changes the hash breaks them
  // knowingly.
  EXPECT_EQ(state_hash(Robot{}), 5094507058633416520ull);
}

}  // namespace
}  // namespace neritic::sim
