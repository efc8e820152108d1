// Missions whose vehicle could not keep its speed over ground for a while: it does not dash off
// once it can. What held it stops: a current falls, thrusters work again, a voltage comes back.
#include <cmath>

#include "tests/testbed/simulation/senders.hpp"

namespace neritic::testbed {
namespace {

constexpr double kHeld_s = 20.0;

// A NumPy file of a current everywhere, along +z (southwards), two samples a second.
void write_southward(const std::filesystem::path& path, const std::vector<float>& speeds_m_s) {
  std::string header = fmt::format(
      "{{'descr': '<f4', 'fortran_order': False, 'shape': ({}, 1, 1, 1, 3), }}", speeds_m_s.size());
  header.resize((10 + header.size() + 1 + 63) / 64 * 64 - 11, ' ');
  header += '\n';
  std::string text("\x93NUMPY\x01\x00", 8);
  text += static_cast<char>(header.size() & 255);
  text += static_cast<char>(header.size() >> 8);
  text += header;
  for (const float speed : speeds_m_s) {
    const std::array<float, 3> sample{0.0f, 0.0f, speed};
    text.append(reinterpret_cast<const char*>(sample.data()), sizeof(sample));
  }
  ASSERT_TRUE(write_text(path, text).ok());
}

// Of a flight northwards, after what held it let go.
struct Release {
  double held_m_s = 1e9;   // the mean before
  double peak_m_s = -1e9;  // the fastest
  double fast_s = 0.0;     // how long it is faster than wanted by a tenth
  double mean_m_s = 0.0;   // from then on when it first has its speed, over 10 s
};

// let_go: called once, after kHeld_s.
Release released(TestDive& dive, double wanted_m_s, const std::function<void()>& let_go = {}) {
  Release out;
  const auto north_m_s = [&] {
    const rov::State& body = dive.vehicle().body;
    return (body.attitude * body.velocity.linear()).x;
  };
  dive.run(kHeld_s - 5.0);
  const double from_m = dive.vehicle().body.position_ned_m.x;
  dive.run(5.0);
  out.held_m_s = (dive.vehicle().body.position_ned_m.x - from_m) / 5.0;
  if (let_go) let_go();
  double had_s = -1.0;
  int count = 0;
  dive.run(25.0, [&] {
    const double now_m_s = north_m_s();
    out.peak_m_s = std::max(out.peak_m_s, now_m_s);
    if (now_m_s > 1.1 * wanted_m_s) out.fast_s += dive.world->step_s();
    if (had_s < 0.0 && now_m_s >= 0.99 * wanted_m_s) had_s = dive.time_s();
    if (had_s < 0.0 || dive.time_s() > had_s + 10.0) return;
    out.mean_m_s += now_m_s;
    ++count;
  });
  EXPECT_GT(count, 1000);
  out.mean_m_s /= std::max(count, 1);
  return out;
}

std::string northward(double speed_m_s, const std::string& keys = "") {
  return fmt::format(
      "position_m = [0, -10, 0]\n[vehicles.mission]\nspeed_m_s = {}\n{}waypoints = [ {{ "
      "position_m = [0, -10, -60] }} ]\n",
      speed_m_s, keys);
}

// Up to 69 % too fast for 17 s before, as long as the speed's integral took to unwind.
TEST(MissionRelease, ACurrentThatFallsLeavesNoVehicleFasterThanItsSpeedByATenth) {
  struct Case {
    double speed_m_s, current_m_s;
    const char* keys;
  };
  const test::ScratchFolder scratch;
  for (const auto& [speed_m_s, current_m_s, keys] :
       {Case{0.5, 0.6, ""}, Case{0.3, 0.7, ""}, Case{0.7, 0.4, ""},
        Case{0.4, 0.6, "heading_deg = 30\n"}}) {
    const double fall_s = 5.0;
    std::vector<float> speeds_m_s;
    for (int i = 0; i < 200; ++i)
      speeds_m_s.push_back(static_cast<float>(
          current_m_s * std::clamp(1.0 - (0.5 * i - kHeld_s) / fall_s, 0.0, 1.0)));
    write_southward(scratch / "current.npy", speeds_m_s);
    TestDive dive = dive_of("[physics]\n[current]\nkind = \"grid\"\nfile = \"" +
                            (scratch / "current.npy").string() +
                            "\"\norigin_m = [0, 0, 0]\nspacing_m = [1, 1, 1]\ninterval_s = 0.5\n" +
                            rov_text(northward(speed_m_s, keys)));
    const Release release = released(dive, speed_m_s);
    EXPECT_LT(release.held_m_s, 0.95 * speed_m_s) << speed_m_s << " " << keys;
    EXPECT_LT(release.peak_m_s, 1.1 * speed_m_s) << speed_m_s << " " << keys;
    EXPECT_NEAR(release.mean_m_s, speed_m_s, 0.04 * speed_m_s) << speed_m_s << " " << keys;
  }
}

// All at once: the fastest is what the thrusters give, but a second later it has its speed.
TEST(MissionRelease, ThrustersThatWorkAgainTakeAVehicleBeyondItsSpeedForASecondAtMost) {
  TestDive dive = dive_of("[physics]\n[current]\nkind = \"uniform\"\nvelocity_m_s = [0, 0, 0.3]\n" +
                          rov_text(northward(0.5)));
  pilot(dive, 0, {.failed_thrusters = 0b0101});  // two of four level ones
  const Release release = released(dive, 0.5, [&] { pilot(dive, 0, {}); });
  EXPECT_LT(release.held_m_s, 0.45);
  EXPECT_LT(release.fast_s, 1.0);
  EXPECT_NEAR(release.mean_m_s, 0.5, 0.03);
}

}  // namespace
}  // namespace neritic::testbed
