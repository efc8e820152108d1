// diver/OUTPUT.md against what `neritic physio`, `plan` and `check` write: the page has every
// column and every key, and names no other. The program itself is run; pictures are drawn in tests
// of its commands.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "engine/core/math.hpp"
#include "tests/support/support.hpp"
#include "tests/tools/page_words.hpp"
#include "tests/tools/undrawn.hpp"
#include "tools/tradeoff/physiology_signals.hpp"

namespace neritic {
namespace {

class OutputPage : public testing::Test {
 protected:
  void SetUp() override { page_ = read_text(test::source_dir() / "diver/OUTPUT.md").value(); }

  // Standard output of a command; fails: the command is expected to fail.
  std::string said_by(const std::string& arguments, bool fails = false) {
    const std::string command =
        fmt::format("{} {}/tools/neritic -q {} > {}", test::kUndrawn, NERITIC_BINARY_DIR, arguments,
                    (folder_ / "said").string());
    EXPECT_EQ(std::system(command.c_str()) != 0, fails) << arguments;
    return read_text(folder_ / "said").value();
  }
  std::string in_folder(const char* name) const { return (folder_ / name).string(); }

  void expect_columns(const std::string& heading, const std::string& table) {
    std::istringstream first(table.substr(0, table.find('\n')));
    Words columns;
    for (std::string name; std::getline(first, name, ',');)
      EXPECT_TRUE(columns.insert(name).second) << "twice: " << name;
    EXPECT_EQ(words_of(page_, heading, "\n## ", true), columns) << heading;
  }
  // Every key is in a row, and what rows begin with are keys.
  void expect_keys(const std::string& heading, const Words& keys) {
    const Words all = words_of(page_, heading, "\n## ", false);
    for (const std::string& key : keys) EXPECT_TRUE(all.contains(key)) << heading << ": " << key;
    for (const std::string& first : words_of(page_, heading, "\n## ", true))
      EXPECT_TRUE(keys.contains(first)) << heading << " has no " << first;
  }
  void expect_keys(const std::string& heading, const std::string& json) {
    const auto parsed = parse_json(json);
    ASSERT_TRUE(parsed.ok()) << parsed.error().message;
    Words keys;
    gather_keys(*parsed, keys);
    expect_keys(heading, keys);
  }
  std::string written(const char* name) const { return read_text(folder_ / name).value(); }

  test::ScratchFolder folder_;
  std::string page_;
};

// Five minutes of beats at 250 Hz, and marks on them: two bytes each, a code over the distance.
TEST_F(OutputPage, OfTheHeart) {
  std::vector<double> beats_s;
  std::vector<std::byte> marks;
  for (double t = 0.8; t < 299.0; t += 0.8) {
    beats_s.push_back(t);
    const unsigned mark = 1u << 10 | 200u;
    marks.push_back(static_cast<std::byte>(mark & 255u));
    marks.push_back(static_cast<std::byte>(mark >> 8));
  }
  marks.resize(marks.size() + 2, std::byte{0});
  std::string text = "# fs_hz=250\necg\n";
  for (const double x : tools::make_ecg(beats_s, 250.0, 300.0, 20.0, 1))
    text += fmt::format("{:.4f}\n", x);
  ASSERT_TRUE(write_text(folder_ / "heart.csv", text).ok());
  ASSERT_TRUE(write_file(folder_ / "heart.atr", marks).ok());
  said_by("physio ecg " + in_folder("heart.csv") + " --annotations " + in_folder("heart.atr") +
          " --out " + in_folder("") + " --plot " + in_folder("p.png"));
  expect_columns("## `physio ecg`: ecg.csv", written("ecg.csv"));
  expect_keys("## `physio ecg`: ecg.json", written("ecg.json"));
  expect_keys("## `physio ecg --plot`", written("p.plot.json"));
}

TEST_F(OutputPage, OfBreath) {
  std::string sound = "# fs_hz=1000\nsound\n";
  for (int i = 0; i < 20000; ++i)
    sound += fmt::format("{:.4f}\n", std::sin(0.7 * i) * std::sin(0.4e-3 * kPi * i));
  ASSERT_TRUE(write_text(folder_ / "s_12bpm.csv", sound).ok());
  said_by("physio breath " + in_folder("s_12bpm.csv") + " --out " + in_folder("") + " --plot " +
          in_folder("p.png"));
  expect_columns("## `physio breath`: breath.csv", written("breath.csv"));
  expect_keys("## `physio breath`: breath.json", written("breath.json"));
  expect_keys("## `physio breath --plot`", written("p.plot.json"));
}

TEST_F(OutputPage, OfGaze) {
  std::string gaze = "# fs_hz=500\nx_deg,y_deg,status,evt\n";
  for (int i = 0; i < 1500; ++i)
    gaze += i / 20 == 50
                ? "0,0,0,5\n"
                : fmt::format("{},0,1,{}\n", i / 250 % 2 == 0 ? 0 : 10, i % 250 == 0 ? 2 : 1);
  // A lid that comes down faster than an eye turns.
  gaze += "0,-60,1,5\n";
  for (int i = 0; i < 300; ++i) gaze += "0,0,1,1\n";
  ASSERT_TRUE(write_text(folder_ / "g.csv", gaze).ok());
  const std::string command = "physio gaze " + in_folder("g.csv") + " --out " + in_folder("") +
                              " --intrinsics 500,500,320,240 --plot " + in_folder("p.png");
  said_by(command);
  expect_columns("## `physio gaze`: gaze.csv", written("gaze.csv"));
  expect_keys("## `physio gaze`: gaze.json", written("gaze.json"));
  expect_keys("## `physio gaze --plot`", written("p.plot.json"));
}

TEST_F(OutputPage, OfAPlan) {
  const std::string json = said_by(
      "plan --gas 18/45 ean50 --depth 60 --time 25 --tank 18/45=24,232 --tank ean50=3,60 "
      "--json");
  expect_keys("## `plan`: plan.json", json);
  const auto parsed = parse_json(json);
  ASSERT_TRUE(parsed.ok());
  EXPECT_FALSE((*parsed)["warnings"].empty());
  const std::string row = page_.substr(page_.find("A row of `segments`:"), 200);
  for (const auto& column : (*parsed)["segments"]["columns"])
    EXPECT_NE(row.find("`" + column.get<std::string>() + "`"), row.npos) << column;
}

TEST_F(OutputPage, OfALogOfDepths) {
  ASSERT_TRUE(
      write_text(folder_ / "log.csv", "time_s,depth_m\n0,0\n120,30\n1500,30\n1800,0\n").ok());
  const std::string plan = "plan --log " + in_folder("log.csv");
  said_by(plan + " --out " + in_folder("out"));
  expect_columns("## `plan --log`: log.csv", written("out/log.csv"));
  expect_keys("## `plan --log --json`", said_by(plan + " --json"));
}

TEST_F(OutputPage, OfAPlansPicture) {
  Words keys;
  for (const char* tank : {"", "--tank 18/45=24,232 "}) {
    said_by(fmt::format("plan --gas 18/45 ean50 --depth 60 --time 25 {}--plot {}", tank,
                        in_folder("p.png")));
    const auto json = parse_json(written("p.plot.json"));
    ASSERT_TRUE(json.ok()) << json.error().message;
    gather_keys(*json, keys);
  }
  expect_keys("## `plan`: plan.plot.json", keys);
}

TEST_F(OutputPage, OfChecks) {
  const std::filesystem::path tests = test::source_dir() / "tests";
  Words keys;
  for (const auto& [what, file] : {std::pair{"deco", tests / "diver/data/deco_vectors.json"},
                                   std::pair{"control", tests / "rov/data/control.json"}}) {
    const auto json = parse_json(said_by(fmt::format("check {} {} --json", what, file.string())));
    ASSERT_TRUE(json.ok()) << json.error().message;
    gather_keys(*json, keys);
  }
  expect_keys("## `check --json`", keys);
}

}  // namespace
}  // namespace neritic
