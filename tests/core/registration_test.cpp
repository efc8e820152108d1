// Transforms that are known are found again from pairs of points, with the residual of the noise.
#include "engine/core/registration.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/core/random.hpp"

namespace neritic {
namespace {

using ::testing::HasSubstr;

class Draws {
 public:
  explicit Draws(std::uint64_t index) : key_{20261123, 1, index} {}
  double in(double low, double high) { return low + (high - low) * random_uniform(key_, count_++); }
  Vec3 place(double most) { return {in(-most, most), in(-most, most), in(-most, most)}; }

 private:
  RandomKey key_;
  std::uint64_t count_ = 0;
};

double turn_between(const Quat& a, const Quat& b) {
  const Quat q = glm::conjugate(a) * b;
  return 2.0 * std::atan2(std::hypot(q.x, q.y, q.z), std::abs(q.w));
}

std::vector<PointPair> pairs_of(Draws& draw, const Pose& to_from, std::size_t count,
                                double noise_m) {
  std::vector<PointPair> pairs;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 from = draw.place(2.0);
    pairs.push_back({from, to_from * from + draw.place(noise_m)});
  }
  return pairs;
}

TEST(Registration, AnyTransformIsFoundExactly) {
  for (std::uint64_t i = 0; i < 500; ++i) {
    Draws draw(i);
    const bool level = i % 2 == 0;
    const Vec3 axis = level ? Vec3(0, 1, 0) : glm::normalize(draw.place(1.0));
    const Pose truth{draw.place(100.0), glm::angleAxis(draw.in(-kPi, kPi), axis)};
    const auto pairs = pairs_of(draw, truth, level ? 2 + i % 5 : 3 + i % 5, 0.0);
    const auto found =
        register_points(pairs, level ? RegistrationFreedom::kLevel : RegistrationFreedom::kFree);
    if (!found.ok()) continue;  // three points that happen to lie in a line
    EXPECT_LT(turn_between(found->to_from.rotation, truth.rotation), 1e-6) << i;
    EXPECT_LT(glm::distance(found->to_from.position_m, truth.position_m), 1e-6) << i;
    EXPECT_LT(found->rms_m, 1e-9);
  }
}

// A gauge: half of ten thousand turns must lie within 0.674 of the stated deviation for one axis.
TEST(Registration, TheStatedErrorOfTheTurnIsThatOfManyDraws) {
  double square_sum = 0.0, stated_sum = 0.0;
  constexpr int kDraws = 2000;
  for (int i = 0; i < kDraws; ++i) {
    Draws draw(1000 + static_cast<std::uint64_t>(i));
    const Pose truth{Vec3(0.0), glm::angleAxis(0.7, Vec3(0, 1, 0))};
    const auto found =
        register_points(pairs_of(draw, truth, 8, 0.02), RegistrationFreedom::kLevel).value();
    const double turn = turn_between(found.to_from.rotation, truth.rotation);
    square_sum += turn * turn;
    stated_sum += found.turn_error_rad * found.turn_error_rad;
  }
  EXPECT_NEAR(std::sqrt(square_sum / stated_sum), 1.0, 0.1);
}

TEST(Registration, PointsThatLeaveTheTurnOpenAreRefused) {
  const std::vector<PointPair> upright{{{0, 0, 0}, {1, 0, 0}}, {{0, 1, 0}, {1, 1, 0}}};
  EXPECT_THAT(register_points(upright, RegistrationFreedom::kLevel).error().message,
              HasSubstr("one vertical line"));
  const std::vector<PointPair> line{
      {{0, 0, 0}, {0, 0, 0}}, {{1, 1, 0}, {1, 1, 0}}, {{2, 2, 0}, {2, 2, 0}}};
  EXPECT_THAT(register_points(line, RegistrationFreedom::kFree).error().message,
              HasSubstr("one line"));
  EXPECT_TRUE(register_points(line, RegistrationFreedom::kLevel).ok());
  EXPECT_THAT(register_points({}, RegistrationFreedom::kLevel).error().message,
              HasSubstr("0 pairs; accepted: 2 or more"));
  const std::vector<PointPair> bad{{{0, std::nan(""), 0}, {}}, {{1, 0, 0}, {}}};
  EXPECT_THAT(register_points(bad, RegistrationFreedom::kLevel).error().message,
              HasSubstr("pair 1: found nan"));
}

TEST(Registration, AMirroredFrameIsSeen) {
  Draws draw(5);
  std::vector<PointPair> pairs;
  for (int i = 0; i < 5; ++i) {
    const Vec3 p = draw.place(2.0);
    pairs.push_back({p, Vec3(-p.x + 3.0, p.y, p.z)});
  }
  const auto found = register_points(pairs, RegistrationFreedom::kFree).value();
  EXPECT_GT(found.rms_m, 0.2);
  EXPECT_LT(found.mirrored_rms_m, 1e-9);
}

}  // namespace
}  // namespace neritic
