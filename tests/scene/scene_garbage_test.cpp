// Include loops, garbage, broken and huge scene files: one line each, no crash.
#include <gtest/gtest.h>

#include "engine/core/random.hpp"
#include "tests/scene/scene_texts.hpp"

namespace neritic::scene {
namespace {

TEST(SceneInclude, ALoopIsRefusedWithItsChain) {
  const test::ScratchFolder scratch;
  ASSERT_TRUE(write_text(scratch / "b.toml", "\ninclude = 'c.toml'").ok());
  ASSERT_TRUE(write_text(scratch / "c.toml", "include = ['s.toml']").ok());
  EXPECT_EQ(
      message_of(scratch, "include = 'b.toml'"),
      "c.toml:1: include: found a loop, s.toml -> b.toml -> c.toml -> s.toml; accepted: files that "
      "do not include each other");
  EXPECT_EQ(
      message_of(scratch, "[[sonars]]\ninclude = './s.toml'"),
      "s.toml:2: include: found a loop, s.toml -> s.toml; accepted: files that do not include each "
      "other");
}

TEST(SceneInclude, AWrongKeyInAnIncludedFileIsToldWithThatFilesLine) {
  const test::ScratchFolder scratch;
  ASSERT_TRUE(write_text(scratch / "sonar.toml", "# a sonar\nazimut_deg = 90").ok());
  EXPECT_EQ(message_of(scratch, "[[sonars]]\ninclude = 'sonar.toml'"),
            "sonar.toml:2: sonars[0].azimut_deg: unknown key; nearest known key: azimuth_deg");
}

TEST(SceneInclude, WhatIsNoFileIsRefused) {
  const test::ScratchFolder scratch;
  EXPECT_EQ(message_of(scratch, "include = 'no.toml'"),
            "s.toml:1: include: no.toml: found no such file; accepted: a file that can be read");
  EXPECT_EQ(message_of(scratch, "include = '.'"),
            "s.toml:1: include: : found no plain file; accepted: a file that can be read");
  EXPECT_EQ(message_of(scratch, "include = 3"),
            "s.toml:1: include: found 3; accepted: the path of a TOML file, or a list of such");
  EXPECT_EQ(message_of(scratch, "include = [3]"),
            "s.toml:1: include: found 3; accepted: the path of a TOML file, or a list of such");
}

TEST(SceneInclude, TooDeepOrTooManyIsRefused) {
  const test::ScratchFolder scratch;
  for (int i = 0; i < 12; ++i)
    ASSERT_TRUE(
        write_text(scratch / fmt::format("d{}.toml", i), fmt::format("include = 'd{}.toml'", i + 1))
            .ok());
  ASSERT_TRUE(write_text(scratch / "d12.toml", "").ok());
  EXPECT_EQ(
      message_of(scratch, "include = 'd0.toml'"),
      "d7.toml:1: include: found one more file; accepted: includes up to 8 deep and 1000 in all");
  // Five files a level, five levels deep: 3905 includes.
  for (int i = 0; i < 5; ++i) {
    const std::string next = fmt::format("'f{}.toml'", i + 1);
    ASSERT_TRUE(write_text(scratch / fmt::format("f{}.toml", i),
                           fmt::format("include = [{0}, {0}, {0}, {0}, {0}]", next))
                    .ok());
  }
  ASSERT_TRUE(write_text(scratch / "f5.toml", "").ok());
  EXPECT_NE(message_of(scratch, "include = 'f0.toml'").find("1000 in all"), std::string::npos);
}

TEST(SceneGarbage, TextThatIsNotTomlNamesItsLine) {
  const test::ScratchFolder scratch;
  const std::string message = message_of(scratch, "title = 'a'\nseed = = 3\n");
  EXPECT_EQ(message.substr(0, 19), "s.toml:2: not TOML:") << message;
  EXPECT_EQ(message_of(scratch, "title = 'a'\n\n[=]\nseed = 1\n"),
            "s.toml:3: not TOML: a key, a value or a table's name in brackets is expected");
  EXPECT_EQ(message_of(scratch, std::string("a = 1\n\0", 7)), "s.toml:2: not TOML: a zero byte");
}

// The code point in UTF-8, as RFC 3629 has it.
std::string utf8(std::uint32_t code) {
  const auto tail = [code](int shift) { return static_cast<char>(0x80 | (code >> shift & 0x3f)); };
  if (code < 0x80) return {static_cast<char>(code)};
  if (code < 0x800) return {static_cast<char>(0xc0 | code >> 6), tail(0)};
  if (code < 0x10000) return {static_cast<char>(0xe0 | code >> 12), tail(6), tail(0)};
  return {static_cast<char>(0xf0 | code >> 18), tail(12), tail(6), tail(0)};
}

// toml++ 3.3 does what is undefined on some letters beyond ASCII straight behind a value.
TEST(SceneGarbage, ALetterBeyondAsciiBehindAValueIsRefusedWithItsLine) {
  const test::ScratchFolder scratch;
  const RandomKey key{2024, 3, 0};
  for (std::uint64_t draw = 0; draw < (test::is_thorough() ? 2000u : 500u); ++draw) {
    // Half from the letters of Europe's languages, half from everywhere but the surrogates.
    const std::uint64_t bits = random_bits(key, draw);
    std::uint32_t code =
        0x80 + static_cast<std::uint32_t>(bits >> 1) % (bits & 1 ? 0x780 : 0x10ff80);
    if (code >= 0xd800 && code < 0xe000) code -= 0x1000;
    for (const char* start : {"seed = 1", "seed = [1", "seed = true", "seed = 'a'", "seed = "}) {
      const std::string message = message_of(scratch, "title = 'a'\n" + (start + utf8(code)));
      EXPECT_EQ(message.substr(0, 9), "s.toml:2:") << message << fmt::format(" U+{:04x}", code);
    }
  }
}

TEST(SceneGarbage, RandomBytesAreOneLineEach) {
  const test::ScratchFolder scratch;
  const RandomKey key{2024, 1, 0};
  std::uint64_t draw = 0;
  for (int file = 0; file < 200; ++file) {
    std::string bytes(1 + random_bits(key, draw++) % 3000, '\0');
    for (char& byte : bytes) byte = static_cast<char>(random_bits(key, draw++));
    EXPECT_NE(message_of(scratch, bytes), "loaded");
  }
}

// A good scene with a few bytes changed either loads or is refused with one line.
TEST(SceneGarbage, BrokenScenesNeverCrash) {
  const test::ScratchFolder scratch;
  const auto good = read_text(test::source_dir() / "assets/scenes/pool.toml");
  ASSERT_TRUE(good.ok());
  const RandomKey key{2024, 2, 0};
  std::uint64_t draw = 0;
  for (int file = 0; file < 500; ++file) {
    std::string text = *good;
    for (int change = 0; change < 3; ++change) {
      const std::size_t at = random_bits(key, draw++) % text.size();
      switch (random_bits(key, draw++) % 3) {
        case 0:
          text[at] = static_cast<char>(random_bits(key, draw++));
          break;
        case 1:
          text.erase(at, 1 + random_bits(key, draw++) % 8);
          break;
        default:
          text.insert(at, text.substr(random_bits(key, draw++) % text.size(), 9));
          break;
      }
    }
    message_of(scratch, text);
  }
}

TEST(SceneGarbage, DeepNestingIsRefusedBeforeTheStackEnds) {
  const test::ScratchFolder scratch;
  std::string dotted = "a";
  for (int i = 0; i < 200000; ++i) dotted += ".a";
  EXPECT_NE(message_of(scratch, dotted + " = 1").find("more than 400 dots"), std::string::npos);
  EXPECT_NE(message_of(scratch, "[" + dotted + "]").find("more than 400 dots"), std::string::npos);
  EXPECT_NE(message_of(scratch, "a = " + std::string(100000, '[')).find("not TOML"),
            std::string::npos);
  // As deep as the limits allow: inline tables over many lines, 400 dots each.
  std::string deep;
  for (int i = 0; i < 30; ++i) {
    deep += "a";
    for (int k = 0; k < 399; ++k) deep += ".a";
    deep += " = [\n{";
  }
  EXPECT_NE(message_of(scratch, deep), "loaded");
}

TEST(SceneGarbage, AHugeFileIsRefusedByItsSize) {
  const test::ScratchFolder scratch;
  EXPECT_EQ(message_of(scratch, std::string((4u << 20) + 1, '#')),
            "s.toml: found 4194305 bytes; accepted: a scene file of at most 4194304");
}

TEST(SceneGarbage, AFolderOrNothingIsRefused) {
  const test::ScratchFolder scratch;
  const auto folder = load_scene(scratch.path());
  ASSERT_FALSE(folder.ok());
  EXPECT_EQ(folder.error().code, ErrorCode::kBadInput);
  const auto nothing = load_scene(scratch / "no.toml");
  ASSERT_FALSE(nothing.ok());
  EXPECT_EQ(nothing.error().message, (scratch / "no.toml").string() +
                                         ": found no such file; accepted: a file that can be read");
}

}  // namespace
}  // namespace neritic::scene
