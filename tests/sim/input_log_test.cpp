#include "engine/sim/input_log.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "engine/core/files.hpp"
#include "tests/sim/spring.hpp"
#include "tests/support/support.hpp"

namespace neritic::sim {
namespace {

using test::SpringInputs, test::SpringState;

InputLog<SpringInputs> spring_log() {
  auto spring = test::make_spring({.seed = 42});
  for (int i = 0; i < 5; ++i) {
    spring.push({.force_n = i * 0.1, .unused = Vec3(1.0, 2.0, i), .kick = {1, 2}});
    spring.advance(4);
  }
  return spring.log();
}

TEST(InputLog, WhatIsWrittenReadsBackAndReplays) {
  const neritic::test::ScratchFolder folder;
  const auto log = spring_log();
  ASSERT_TRUE(write_input_log(folder / "run.log", log).ok());
  const auto read = read_input_log<SpringInputs>(folder / "run.log");
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(read->seed, 42u);
  EXPECT_EQ(read->step_s, log.step_s);
  EXPECT_EQ(read->hashes, log.hashes);
  ASSERT_EQ(read->entries.size(), log.entries.size());
  for (std::size_t i = 0; i < log.entries.size(); ++i) {
    EXPECT_EQ(read->entries[i].step, log.entries[i].step);
    EXPECT_TRUE(same_bits(read->entries[i].inputs, log.entries[i].inputs));
  }
  EXPECT_FALSE(replay(*read, SpringState{}, test::spring_step).first_difference.has_value());
}

// The format's description, read by hand.
TEST(InputLog, BytesLieAsTheFormatSays) {
  const RawInputLog log{0.25,
                        7,
                        {{'I', "on"}},
                        {{0, {std::byte{9}, std::byte{0}, std::byte{0}, std::byte{0}}}},
                        {0x1122334455667788ull, 3}};
  const std::vector<int> expected{
      'N',  'R',  'T',  'C',  'L',  'O',  'G',  '1',                           //
      0,    0,    0,    0,    0,    0,    0xd0, 0x3f, 7, 0, 0, 0, 0, 0, 0, 0,  // 0.25, seed
      1,    0,    0,    0,    0,    0,    0,    0,    1, 0, 0, 0, 0, 0, 0, 0,  // steps, entries
      1,    0,    0,    0,    'I',  2,    'o',  'n',                           // fields
      0,    0,    0,    0,    0,    0,    0,    0,    9, 0, 0, 0,              // entry
      0x88, 0x77, 0x66, 0x55, 0x44, 0x33, 0x22, 0x11, 3, 0, 0, 0, 0, 0, 0, 0};
  const auto bytes = encode_input_log(log);
  ASSERT_EQ(bytes.size(), expected.size());
  for (std::size_t i = 0; i < bytes.size(); ++i)
    EXPECT_EQ(std::to_integer<int>(bytes[i]), expected[i]) << i;
}

TEST(InputLog, EveryTruncationAndEveryExtraByteIsRefusedInOneLine) {
  const neritic::test::ScratchFolder folder;
  ASSERT_TRUE(write_input_log(folder / "run.log", spring_log()).ok());
  auto bytes = *read_file(folder / "run.log");
  const auto expect_refused = [](std::span<const std::byte> text, std::size_t size) {
    const auto log = parse_input_log(text, "cut.log");
    ASSERT_FALSE(log.ok()) << size;
    EXPECT_TRUE(log.error().message.starts_with("cut.log: ")) << log.error().message;
    EXPECT_EQ(log.error().message.find('\n'), std::string::npos);
  };
  for (std::size_t n = 0; n < bytes.size(); ++n) expect_refused(std::span(bytes).first(n), n);
  bytes.push_back(std::byte{0});
  expect_refused(bytes, bytes.size());
}

struct BadLog {
  const char* says;
  void (*spoil)(RawInputLog&);
};

RawInputLog good_log() {
  const double force_n = 1.5;
  const auto bytes = std::as_bytes(std::span(&force_n, 1));
  const std::vector<std::byte> numbers(bytes.begin(), bytes.end());
  return {0.25, 7, {{'d', "force_n"}}, {{0, numbers}, {2, numbers}}, {1, 2, 3}};
}

TEST(InputLog, WhatIsWrongIsNamed) {
  const BadLog cases[] = {
      {"a step of -1 s; accepted: over 0 to 1 s", [](RawInputLog& log) { log.step_s = -1.0; }},
      {"a step of nan s",
       [](RawInputLog& log) { log.step_s = std::numeric_limits<double>::quiet_NaN(); }},
      {"field 0 has type number 120; accepted: one of d f i I q Q",
       [](RawInputLog& log) { log.fields[0].type = 'x'; }},
      {"field 0 has a name that is not printable text",
       [](RawInputLog& log) { log.fields[0].name = "a\nb"; }},
      {"0 fields; accepted: 1 to 1000000", [](RawInputLog& log) { log.fields.clear(); }},
      {"no entries", [](RawInputLog& log) { log.entries.clear(); }},
      {"entry 0 is of step 1; accepted: ascending from 0 to 2",
       [](RawInputLog& log) { log.entries[0].step = 1; }},
      {"entry 1 is of step 0", [](RawInputLog& log) { log.entries[1].step = 0; }},
      {"entry 1 is of step 3", [](RawInputLog& log) { log.entries[1].step = 3; }},
      {"step 2: force_n is not finite",
       [](RawInputLog& log) { log.entries[1].numbers.assign(8, std::byte{0xff}); }},
  };
  ASSERT_TRUE(parse_input_log(encode_input_log(good_log()), "good.log").ok());
  for (const BadLog& bad : cases) {
    RawInputLog log = good_log();
    bad.spoil(log);
    const auto parsed = parse_input_log(encode_input_log(log), "bad.log");
    ASSERT_FALSE(parsed.ok()) << bad.says;
    EXPECT_NE(parsed.error().message.find(std::string("bad.log: ") + bad.says), std::string::npos)
        << parsed.error().message;
  }
}

TEST(InputLog, ALogOfOtherInputsIsRefusedByTheFieldThatDiffers) {
  const neritic::test::ScratchFolder folder;
  ASSERT_TRUE(write_raw_input_log(folder / "other.log", good_log()).ok());
  const auto fewer = read_input_log<SpringInputs>(folder / "other.log");
  ASSERT_FALSE(fewer.ok());
  EXPECT_NE(fewer.error().message.find("1 fields; accepted: 6"), std::string::npos);
  RawInputLog renamed = good_log();
  renamed.fields[0].name = "torque_nm";
  ASSERT_TRUE(write_raw_input_log(folder / "other.log", renamed).ok());
  const auto other = read_input_log<SpringInputs>(folder / "other.log");
  ASSERT_FALSE(other.ok());
  EXPECT_NE(other.error().message.find("field 0 is 'torque_nm' of type d; accepted: 'force_n'"),
            std::string::npos);
}

}  // namespace
}  // namespace neritic::sim
