// YAML of calibration files, as JSON: the layouts that ROS, ros2 topic echo and OpenCV write.
#include "engine/core/yaml.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/core/json.hpp"

namespace neritic {
namespace {

std::string as_json(const std::string& yaml) {
  const auto parsed = parse_yaml(yaml);
  return parsed.ok() ? json_text(*parsed, -1) : parsed.error().message;
}

TEST(Yaml, CalibrationFilesReadAsTheyMean) {
  EXPECT_EQ(as_json("image_width: 640\ncamera_name: 'left # 1'  # ours\nempty:\n"
                    "K:\n  rows: 3\n  data: [5.25e+02, 0., -1,\n         +2, 1]\nlast: true\n"),
            R"({"K":{"data":[525.0,0.0,-1.0,2,1],"rows":3},"camera_name":"left # 1","empty":null,)"
            R"("image_width":640,"last":true})");
  EXPECT_EQ(as_json("header:\n  stamp:\n    sec: 7\nd:\n- 0.0\n- -0.5\nk:\n  - 1.5\n---\nk: 2\n"),
            R"({"d":[0.0,-0.5],"header":{"stamp":{"sec":7}},"k":[1.5]})");
  EXPECT_EQ(
      as_json("%YAML:1.0\n---\nM1: !!opencv-matrix\n   rows: 3\n   dt: d\n   data: [ 1., 2. ]\n"
              "date: \"Mon: 3\"\n"),
      R"({"M1":{"data":[1.0,2.0],"dt":"d","rows":3},"date":"Mon: 3"})");
  EXPECT_EQ(as_json("frames:\n  - id: a\n    fx: 1\n  -\n    id: b\n- 1\n").substr(0, 7),
            "line 6:");
  EXPECT_EQ(as_json("frames:\n  - id: a\n    fx: 1\n  -\n    id: {x: [1, [2]], y: it's}\n"),
            R"({"frames":[{"fx":1,"id":"a"},{"id":{"x":[1,[2]],"y":"it's"}}]})");
  EXPECT_EQ(as_json("# nothing\n"), "null");
}

// The time grows with the length: a second look over all lines before would take minutes.
TEST(Yaml, AListOverManyLinesIsReadInOnePass) {
  constexpr std::size_t kLines = 200'000;
  std::string text = "data: [\n";
  for (std::size_t i = 0; i < kLines; ++i) text += i % 2 ? "  1.5, # one\n" : "  '[', \n";
  const auto parsed = parse_yaml(text + "  ]\nlast: 3\n");
  ASSERT_TRUE(parsed.ok()) << parsed.error().message;
  EXPECT_EQ((*parsed)["data"].size(), kLines);
  EXPECT_EQ((*parsed)["last"], 3);
}

TEST(Yaml, WhatIsNotReadIsRefusedWithItsLine) {
  const std::pair<const char*, const char*> cases[] = {
      {"a: 1\n b: 2\n", "line 2: found 'b: 2'"},
      {"a: 1\n\tb: 2\n", "line 2: found 'a tab'"},
      {"a: &x 1\n", "line 1: found '&x 1'; accepted: plain values"},
      {"a: |\n  text\n", "line 1: found '|'"},
      {"a: 1\na: 2\n", "line 2: found 'a'; accepted: each key once"},
      {"a: [1, 2\nb: 3\n", "line 1: found '[1, 2 b: 3'; accepted: brackets that close"},
      {"a: 'x\n", "quotes that close"}};
  for (const auto& [text, words] : cases) {
    EXPECT_THAT(as_json(text), ::testing::HasSubstr(words)) << text;
  }
  std::string deep;
  for (int i = 0; i < 200; ++i) deep += "- ";
  EXPECT_THAT(as_json(deep + "1"), ::testing::HasSubstr("shallower nesting"));
  EXPECT_THAT(as_json("a: " + std::string(500, '[') + std::string(500, ']')),
              ::testing::HasSubstr("shallower nesting"));
}

}  // namespace
}  // namespace neritic
