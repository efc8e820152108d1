// A heart strap by Bluetooth, at a stand-in for BlueZ (tests/fakes/bluez): connected, asked for its
// ECG, heard, lost and found again.
#include <dlfcn.h>

#include <chrono>
#include <thread>

#include "engine/core/text.hpp"
#include "tests/fakes/bluez/fake_bluez.hpp"
#include "tests/testbed/devices/lab_scene.hpp"

namespace neritic::testbed {
namespace {

using net::bytes_of;
using test::FakeBluez;
using Characteristic = FakeBluez::Characteristic;

// The program loads libsystemd for sd-bus; a system without systemd need not have it.
class BluetoothStrap : public testing::Test {
 protected:
  void SetUp() override {
    void* const library = ::dlopen("libsystemd.so.0", RTLD_NOW | RTLD_LOCAL);
    if (!library) GTEST_SKIP() << "no libsystemd.so.0 here; package libsystemd0 has it";
    ::dlclose(library);
  }
};

struct BluetoothLab {
  explicit BluetoothLab(const std::string& name = "Polar H10")
      : dive(dive_of(lab_text("strap = \"strap bluetooth " + name + "\"\n"))) {
    auto opened = DeviceSource::open(dive.scene.sources.at(0), *dive.world,
                                     dive.simulation->inbox(), DeviceSource::Pace::kThread);
    EXPECT_TRUE(opened.ok()) << opened.error().message;
    if (opened.ok()) source = std::move(opened).value();
  }
  // Waits until it is true, at most fifteen seconds: the strap is looked for every five.
  bool until(const std::function<bool()>& done) const {
    for (int i = 0; i < 1500 && !done(); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return done();
  }
  net::LinkCounts counts() const { return source->health().link; }
  TestDive dive;
  std::unique_ptr<DeviceSource> source;
};

bool has(const std::vector<std::string>& calls, const std::string& call) {
  return std::ranges::find(calls, call) != calls.end();
}

TEST_F(BluetoothStrap, IsConnectedAskedForItsEcgHeardLostAndFoundAgain) {
  const nlohmann::json vectors = net::wire_vectors();
  const std::string start =
      "WriteValue control " + lower_case(vectors["polar_pmd"]["start_ecg"].get<std::string>());
  FakeBluez bluez(false);
  BluetoothLab lab;
  ASSERT_TRUE(lab.source);
  ASSERT_TRUE(lab.until([&] { return has(bluez.calls(), start); }));
  EXPECT_EQ(bluez.calls(),
            (std::vector<std::string>{"Connect", "StartNotify rate", "StartNotify control",
                                      "StartNotify ecg", start}));
  ASSERT_TRUE(lab.until([&] { return lab.source->health().trouble.empty(); }));
  bluez.notify(Characteristic::kRate, bytes_of(std::string("003C")));
  ASSERT_TRUE(lab.until([&] { return lab.counts().used == 1; }));
  const auto drained = lab.dive.simulation->inbox().drain();
  ASSERT_EQ(drained.size(), 1u);
  EXPECT_EQ(std::get<Heart>(drained[0].payload).state.rate_bpm, 60.0);
  bluez.notify(Characteristic::kEcg, bytes_of(vectors["polar_pmd"]["frames"][0]));
  bluez.notify(Characteristic::kRate, bytes_of(std::string("003D")));
  ASSERT_TRUE(lab.until([&] { return lab.counts().datagrams == 3; }));
  EXPECT_EQ(lab.counts().used, 2u);
  EXPECT_EQ(lab.counts().unused, 1u);  // the rate, while there is an ECG
  bluez.leave();
  ASSERT_TRUE(lab.until([&] { return lab.source->health().trouble != ""; }));
  ASSERT_TRUE(lab.until([&] { return std::ranges::count(bluez.calls(), start) >= 2; }));
  EXPECT_GE(std::ranges::count(bluez.calls(), "Connect"), 2);
  ASSERT_TRUE(lab.until([&] { return lab.source->health().trouble.empty(); }));
}

TEST_F(BluetoothStrap, OneThatVanishesWithoutAWordIsLookedForAgain) {
  FakeBluez bluez(true);
  BluetoothLab lab;
  ASSERT_TRUE(lab.source);
  ASSERT_TRUE(lab.until([&] { return has(bluez.calls(), "StartNotify ecg"); }));
  bluez.vanish();
  ASSERT_TRUE(lab.until([&] { return has(bluez.calls(), "Connect"); }));
  ASSERT_TRUE(lab.until([&] { return std::ranges::count(bluez.calls(), "StartNotify ecg") >= 2; }));
}

TEST_F(BluetoothStrap, OneThatStaysSilentIsTold) {
  FakeBluez bluez(true);
  BluetoothLab lab;
  ASSERT_TRUE(lab.source);
  // Asked again, and connected all the while.
  ASSERT_TRUE(lab.until([&] { return std::ranges::count(bluez.calls(), "StartNotify ecg") >= 2; }));
  ASSERT_TRUE(lab.until([&] { return lab.source->health().trouble == "the strap is silent"; }));
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_EQ(lab.source->health().trouble, "the strap is silent");
  bluez.notify(Characteristic::kRate, bytes_of(std::string("003C")));
  ASSERT_TRUE(lab.until([&] { return lab.source->health().trouble.empty(); }));
}

TEST_F(BluetoothStrap, OneThatIsNotPairedIsNamed) {
  FakeBluez bluez(true);
  const BluetoothLab lab("Garmin HRM");
  ASSERT_TRUE(lab.source);
  ASSERT_TRUE(lab.until([&] { return lab.source->health().trouble != ""; }));
  EXPECT_EQ(lab.source->health().trouble,
            "no strap Garmin HRM is known; pair it once with bluetoothctl");
  EXPECT_TRUE(bluez.calls().empty());
}

TEST_F(BluetoothStrap, WithoutABusItIsRefusedInOneLine) {
  ::setenv("DBUS_SYSTEM_BUS_ADDRESS", "unix:path=/nowhere/bus", 1);
  TestDive dive = dive_of(lab_text("strap = \"strap bluetooth Polar H10\"\n"));
  const auto opened = DeviceSource::open(dive.scene.sources.at(0), *dive.world,
                                         dive.simulation->inbox(), DeviceSource::Pace::kThread);
  ::unsetenv("DBUS_SYSTEM_BUS_ADDRESS");
  ASSERT_FALSE(opened.ok());
  EXPECT_NE(opened.error().message.find("no system D-Bus"), std::string::npos)
      << opened.error().message;
}

}  // namespace
}  // namespace neritic::testbed
