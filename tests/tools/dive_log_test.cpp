// testbed/record/LOG.md against what `neritic dive` writes: the page has every column of the log,
// every key of --json and of a picture's data, and no other. The program itself is run.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "tests/support/support.hpp"
#include "tests/tools/page_words.hpp"

namespace neritic {
namespace {

// A vehicle with every sensor and a tether, and a diver to whom all befalls: too deep on a small
// tank of air, an inflator that freezes open; richer gas for the surface.
class DiveLog : public testing::Test {
 protected:
  void SetUp() override {
    const std::string assets = (test::source_dir() / "assets").string();
    ASSERT_TRUE(write_text(folder_ / "b.csv", "t_s,inflate\n20,1\n").ok());
    ASSERT_TRUE(
        write_text(
            folder_ / "d.toml",
            "tanks = [ { volume_l = 3, pressure_bar = 200 }, { volume_l = 0.5, oxygen = 0.5 } ]\n"
            "[computer]\ngf_low = 0.1\ngf_high = 0.2\n")
            .ok());
    ASSERT_TRUE(write_text(folder_ / "s.toml", R"(title = "all"
[physics]
[[objects]]
name = "diver"
model = ")" + assets + R"(/models/diver.glb"
human = "d.toml"
jacket_buttons = "b.csv"
modem = { usbl = { target = "rov" } }
position_m = [0, -150, 0]
pitch_deg = -90
[[vehicles]]
name = "rov"
shape = "box"
size_m = [0.57, 0.26, 0.46]
dynamics = ")" + assets + R"(/vehicles/bluerov2_heavy_survey_dynamics.toml"
position_m = [3, -150, 0]
modem = {}
inputs = { setpoint = "planner" }
tether = { from_m = [3, -140, 0], length_m = 20, segments = 2 }
mission = { waypoints = [ { position_m = [3, -150, -1] } ] }
)")
                    .ok());
    const std::string command = fmt::format(
        "{}/tools/neritic dive {} --headless --seconds 300 --log-rate 0.1 --json --log {} "
        "--plot {} > {}",
        NERITIC_BINARY_DIR, (folder_ / "s.toml").string(), (folder_ / "log.csv").string(),
        (folder_ / "dive.png").string(), (folder_ / "out.json").string());
    ASSERT_EQ(std::system(command.c_str()), 0);
    page_ = read_text(test::source_dir() / "testbed/record/LOG.md").value();
  }

  test::ScratchFolder folder_;
  std::string page_;
};

// One dive for the log, the summary and the picture's data, since it costs most of the test.
TEST_F(DiveLog, ThePageHasEveryColumnAndKeyAndNoOther) {
  {
    SCOPED_TRACE("columns of the log");
    const std::string log = read_text(folder_ / "log.csv").value();
    std::istringstream heading(log.substr(0, log.find('\n')));
    Words columns;
    for (std::string name; std::getline(heading, name, ',');) {
      EXPECT_TRUE(columns.insert(name).second) << "twice: " << name;
      for (const char* kind : {"command_", "thrust_"})
        if (name.starts_with(kind) && name.ends_with("_n")) columns.erase(name);
    }
    columns.insert({"command_N_n", "thrust_N_n"});
    EXPECT_EQ(words_of(page_, "## The log", "## The summary", true), columns);
  }
  {
    SCOPED_TRACE("keys of the summary");
    auto json = parse_json(read_text(folder_ / "out.json").value());
    ASSERT_TRUE(json.ok()) << json.error().message;
    // Groups of inputs are keys of their names.
    for (const char* kind : {"vehicles", "humans"})
      for (auto& one : (*json)[kind]) {
        auto groups = nlohmann::json::array();
        for (const auto& group : one["inputs"]) groups.push_back(group);
        one["inputs"] = groups;
      }
    const auto& dangers = (*json)["humans"][0]["dangers"];
    for (const auto& [danger, what] : dangers.items()) EXPECT_FALSE(what.is_null()) << danger;
    Words keys;
    gather_keys(*json, keys);
    EXPECT_EQ(words_of(page_, "## The summary", "\n## ", false), keys);
  }
  {
    SCOPED_TRACE("keys of the picture's data");
    const auto json = parse_json(read_text(folder_ / "dive.plot.json").value());
    ASSERT_TRUE(json.ok()) << json.error().message;
    Words keys;
    gather_keys(*json, keys);
    const std::string heading = "## The picture's data";
    const Words all = words_of(page_, heading, "\n## ", false);
    for (const std::string& key : keys) EXPECT_TRUE(all.contains(key)) << key;
    for (const std::string& key : words_of(page_, heading, "\n## ", true))
      EXPECT_TRUE(keys.contains(key)) << key;
    EXPECT_TRUE(std::filesystem::exists(folder_ / "dive.png"));
  }
}

}  // namespace
}  // namespace neritic
