// The jacket's buttons out of a table: which are pressed when; and what is wrong is said in one
// line.
#include "diver/button_recording.hpp"

#include <gtest/gtest.h>

#include "diver/jacket.hpp"

namespace neritic::diver {
namespace {

TEST(ButtonRecording, EachRowHoldsUntilTheNext) {
  const auto r = read_button_recording(
      "t_s,dump,inflate\n# inflates, then pulls the cord too\n2,0,1\n3.5,1,1\n5,0,0\n", "b.csv");
  ASSERT_TRUE(r.ok()) << r.error().message;
  EXPECT_EQ(r->at(1.999), std::nullopt);  // as the swimmer wants
  EXPECT_EQ(r->at(2.0), kInflate);
  EXPECT_EQ(r->at(3.499), kInflate);
  EXPECT_EQ(r->at(3.5), kInflate | kDump);
  EXPECT_EQ(r->at(5.0), 0u);
  EXPECT_EQ(r->at(1e9), 0u);
}

TEST(ButtonRecording, UnitsOfTimeAreThoseOfItsName) {
  const auto r = read_button_recording("time_ms;deflate\n1500;1\n", "b.csv");
  ASSERT_TRUE(r.ok()) << r.error().message;
  EXPECT_EQ(r->at(1.4), std::nullopt);
  EXPECT_EQ(r->at(1.6), kDeflate);
}

TEST(ButtonRecording, WhatIsWrongIsSaidInOneLine) {
  const struct {
    const char *text, *message;
  } wrong[] = {
      {"inflate\n1\n", "accepted: t_s and any of inflate, deflate, dump"},
      {"t_s\n1\n", "t_s and any of inflate"},
      {"t_s,inflat\n0,1\n", "found a column inflat; accepted: t_s, inflate, deflate, dump"},
      {"t_s,inflate\n", "b.csv"},
      {"t_s,inflate\n3,1\n3,0\n", "b.csv:3: found time 3; accepted: times that rise"},
      {"t_s,inflate\n1e12,1\n", "b.csv:2: found time 1000000000000"},
      {"t_s,inflate\nnan,1\n", "b.csv:2: found time nan"},
      {"# a test\n\nt_s,inflate,dump\n1,0,2\n", "b.csv:4: dump: found 2; accepted: 0 and 1"},
      {"t_s,inflate\n1,\n", "b.csv:2: inflate: found nan; accepted: 0 and 1"}};
  for (const auto& one : wrong) {
    const auto r = read_button_recording(one.text, "b.csv");
    ASSERT_FALSE(r.ok()) << one.text;
    EXPECT_NE(r.error().message.find(one.message), std::string::npos) << r.error().message;
    EXPECT_TRUE(r.error().message.starts_with("b.csv"));
    EXPECT_EQ(r.error().message.find('\n'), std::string::npos);
  }
}

}  // namespace
}  // namespace neritic::diver
