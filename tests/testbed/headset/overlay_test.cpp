// `neritic hud`: the instruments of a dive that was recorded or runs elsewhere, over another
// program, in a process of its own.
#include <signal.h>

#include <thread>

#include "tests/testbed/headset/headset_process.hpp"

namespace neritic::testbed {
namespace {

constexpr const char* kOver = "size 400 400\nperiod 0.05\nreal_time yes\nbackground 0 0.2 0\n";

class OverlayProcess : public HeadsetProcess {
 protected:
  int record() const {
    return run("dive '" + scene() + "' --headless --seconds 6 --record '" + path("dive.mcap") +
               "' -q");
  }
  int replay(const std::string& lines) const {
    script(lines);
    return run("hud --replay '" + path("dive.mcap") + "' --hud mask,console --frames 6 --validate");
  }
  // Pixels of the instruments, and those of the other program that nothing covers.
  std::pair<std::size_t, std::size_t> ink_and_other(int frame) const {
    const auto file = scratch_ / fmt::format("overlay_frame_{:04}_view_0.png", frame);
    const ImageU8 seen = scene::read_image8(file).value();
    std::size_t ink = 0, other = 0;
    for (std::uint32_t y = 0; y < seen.height; ++y)
      for (std::uint32_t x = 0; x < seen.width; ++x) {
        const auto* p = &seen.at(x, y);
        ink += p[0] > 150 && p[1] > 150 && p[2] > 150;
        other += p[0] == 0 && p[2] == 0 && p[1] > 100;
      }
    return {ink, other};
  }
  // Pixels of an alarm's red and yellow.
  std::size_t alarmed(int frame) const {
    const auto file = scratch_ / fmt::format("overlay_frame_{:04}_view_0.png", frame);
    const ImageU8 seen = scene::read_image8(file).value();
    std::size_t count = 0;
    for (std::uint32_t y = 0; y < seen.height; ++y)
      for (std::uint32_t x = 0; x < seen.width; ++x) {
        const auto* p = &seen.at(x, y);
        count += p[0] > 180 && p[2] < 120;
      }
    return count;
  }
};

TEST_F(OverlayProcess, LaysItsPanelsOverTheOtherProgramAndDrawsNoView) {
  ASSERT_EQ(record(), 0) << said();
  ASSERT_EQ(replay(fmt::format("{}out {}\nout_frames 4\n", kOver, path(""))), 0) << said();
  EXPECT_EQ(text("report"), "");
  const auto [ink, other] = ink_and_other(4);
  EXPECT_GT(ink, 500u);
  EXPECT_GT(other, 20000u);
  EXPECT_EQ(replay("without XR_EXTX_overlay\n"), 1);
  EXPECT_EQ(said(),
            "neritic: the OpenXR runtime has no XR_EXTX_overlay: it shows nothing over another "
            "program\n");
}

// A server process whose address it says.
class ServedProcess {
 public:
  ServedProcess(const std::string& command, std::function<std::string()> said)
      : said_(std::move(said)) {
    pid_ = fork();
    if (pid_ == 0) {
      setpgid(0, 0);
      execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
      _exit(127);
    }
  }
  ~ServedProcess() { end(); }
  void end() {
    if (pid_ <= 0) return;
    kill(-pid_, SIGINT);
    int status = 0;
    waitpid(pid_, &status, 0);
    pid_ = -1;
  }
  // "tcp://127.0.0.1:PORT"; empty: it did not come.
  std::string address() const {
    for (int i = 0; i < 600; ++i, std::this_thread::sleep_for(std::chrono::milliseconds(50))) {
      const std::string text = said_();
      const auto at = text.find("tcp://");
      const auto end = text.find(',', at);
      if (at != text.npos && end != text.npos) return text.substr(at, end - at);
    }
    return "";
  }

 private:
  pid_t pid_ = -1;
  std::function<std::string()> said_;
};

// Frame 30 is seen while the dive runs; it is then ended, and the others are seen some 5 s later:
// one after the other, since a slow machine's frames may last as long as a flash.
TEST_F(OverlayProcess, ADiveThatRunsElsewhereFeedsItAndALostConnectionIsAnAlarm) {
  constexpr int kFirst = 130, kLast = 141;
  std::string frames = "30";
  for (int frame = kFirst; frame <= kLast; ++frame) frames += fmt::format(" {}", frame);
  script(fmt::format("{}out {}\nout_frames {}\n", kOver, path(""), frames));
  ServedProcess server(
      command("serve '" + scene() + "' --realtime --bind tcp://127.0.0.1:47931", "served"),
      [&] { return text("served"); });
  const std::string address = server.address();
  ASSERT_NE(address, "") << text("served");
  int status = -1;
  std::thread hud([&] {
    status = run(fmt::format("hud --connect {} --frames {} --validate", address, kLast + 1));
  });
  const auto first = scratch_ / "overlay_frame_0030_view_0.png";
  for (int i = 0; i < 400 && !std::filesystem::exists(first); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  server.end();
  hud.join();
  ASSERT_EQ(status, 0) << said();
  EXPECT_EQ(text("report"), "");
  EXPECT_GT(ink_and_other(30).first, 150u);  // dashes have some 50
  EXPECT_EQ(alarmed(30), 0u);
  // It flashes, twice a second.
  std::size_t most = 0;
  for (int frame = kFirst; frame <= kLast; ++frame) most = std::max(most, alarmed(frame));
  EXPECT_GT(most, 300u);
}

TEST_F(OverlayProcess, ABadAddressOrNoServerIsOneLine) {
  script(kOver);
  EXPECT_EQ(run("hud --connect 127.0.0.1:47"), 2);
  EXPECT_EQ(said().find("neritic: --connect: found"), 0u) << said();
  EXPECT_EQ(run("hud --connect udp://127.0.0.1:47910"), 2);
  EXPECT_EQ(said(),
            "neritic: --connect: found 'udp://127.0.0.1:47910'; accepted: tcp://ADDRESS:PORT\n");
}

}  // namespace
}  // namespace neritic::testbed
