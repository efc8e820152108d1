// The promises of a Result that holds a value or an error, and of one that is asked for the other.
#include "engine/core/result.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace neritic {
namespace {

Result<int> half(int n) {
  if (n % 2 != 0) return bad_input("n: found {}; accepted: an even number", n);
  return n / 2;
}

Result<int> quarter(int n) {
  NERITIC_TRY(const int once, half(n));
  return half(once);
}

TEST(Result, TryHandsOnTheValueOrTheError) {
  EXPECT_EQ(quarter(12).value(), 3);
  ASSERT_FALSE(quarter(6).ok());
  EXPECT_EQ(quarter(6).error().message, "n: found 3; accepted: an even number");
  EXPECT_EQ(exit_status(quarter(6).error().code), 2);
}

TEST(Result, ValuesThatOnlyMoveMoveOut) {
  Result<std::unique_ptr<int>> owner(std::make_unique<int>(7));
  EXPECT_EQ(**owner, 7);
  const std::unique_ptr<int> out = std::move(owner).value();
  EXPECT_EQ(*out, 7);
}

TEST(Result, CopiesAndTakesTheOther) {
  const std::string words(40, 'a');  // too long to lie within the string
  Result<std::string> result(words);
  Result<std::string> copy = result;
  EXPECT_EQ(*copy, words);
  copy = bad_input("{}", words);
  EXPECT_EQ(copy.error().message, words);
  EXPECT_EQ(*result, words);
  Result<std::string> error = copy;
  copy = result;
  EXPECT_EQ(*copy, words);
  result = std::move(error);
  EXPECT_EQ(result.error().message, words);
  Result<std::string>& itself = result;
  result = itself;
  EXPECT_EQ(result.error().message, words);
}

TEST(ResultDeathTest, TheValueOfAnErrorEndsTheProgramWithTheErrorsMessage) {
  EXPECT_DEATH((void)half(5).value(), "check failed: .*n: found 5; accepted: an even number");
  const Result<int> odd = half(7);
  EXPECT_DEATH((void)*odd, "n: found 7");
  const Result<std::string> none(bad_input("no text"));
  EXPECT_DEATH((void)none->size(), "no text");
}

TEST(ResultDeathTest, TheErrorOfAValueEndsTheProgram) {
  EXPECT_DEATH((void)half(4).error(), "check failed: Result has an error");
  EXPECT_DEATH((void)Status().error(), "check failed: Result has an error");
}

}  // namespace
}  // namespace neritic
