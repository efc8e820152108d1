// Ctrl-C in the middle of `neritic render` and `neritic sonar`: what is there is whole, one line
// says how to go on, and going on makes the rest.
#include "tools/neritic/interrupt.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <optional>
#include <thread>

#include "engine/core/npy.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/support/support.hpp"
#include "tests/tools/sonar_command.hpp"

namespace neritic {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

// Sends this process a SIGINT once the file is there. The command under test listens by then.
class InterruptWhen {
 public:
  explicit InterruptWhen(fs::path file)
      : thread_([file = std::move(file)](const std::stop_token& stop) {
          while (!fs::exists(file))
            if (stop.stop_requested())
              return;
            else
              std::this_thread::sleep_for(std::chrono::milliseconds(1));
          std::raise(SIGINT);
        }) {}

 private:
  std::jthread thread_;
};

TEST(Interrupt, TheFirstSignalSetsAFlagWhileOneLives) {
  for (int time = 0; time < 2; ++time) {
    const tools::Interrupt interrupt;
    EXPECT_FALSE(interrupt.requested());
    std::raise(time == 0 ? SIGINT : SIGTERM);
    EXPECT_TRUE(interrupt.requested());
  }
}

TEST(Interrupt, AHangUpThatIsIgnoredStaysSo) {
  std::signal(SIGHUP, SIG_IGN);
  {
    const tools::Interrupt interrupt;
    std::raise(SIGHUP);
    EXPECT_FALSE(interrupt.requested());
  }
  EXPECT_EQ(std::signal(SIGHUP, SIG_DFL), SIG_IGN);
  const tools::Interrupt interrupt;
  std::raise(SIGHUP);
  EXPECT_TRUE(interrupt.requested());
}

TEST(InterruptDeathTest, TheSecondSignalEndsTheProgram) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        const tools::Interrupt interrupt;
        std::raise(SIGINT);
        std::this_thread::sleep_for(std::chrono::milliseconds(600));
        std::raise(SIGINT);
      },
      ::testing::KilledBySignal(SIGINT), "");
}

// `timeout` signals the program, then its group, which the program is in.
TEST(Interrupt, ASignalRepeatedAtOnceIsTheSameWish) {
  const tools::Interrupt interrupt;
  for (int time = 0; time < 5; ++time) std::raise(SIGTERM);
  EXPECT_TRUE(interrupt.requested());
}

TEST(Interrupt, AFolderOfImagesGoesOnWhereItWasStopped) {
  const test::ScratchFolder folder;
  const std::size_t frames = 600, side = 40;
  fs::create_directories(folder / "depth");
  const std::vector<float> depth(side * side, 2.0f);
  for (std::size_t i = 0; i < frames; ++i)
    NERITIC_ASSERT_STATUS(
        write_npy(folder / "depth" / fmt::format("{:04}.npy", i), depth, {side, side}));
  const fs::path out = folder / "out";
  const test::Words words{"imaging",      "--depth",       (folder / "depth").string(),
                          "--intrinsics", "20,20,20,20",   "--out",
                          out.string(),   "--no-pictures", "--method",
                          "reference",    "--bins",        "50,20,20"};
  Status stopped;
  {
    const InterruptWhen at(out / "0003" / "sonar.json");
    stopped = test::sonar_command(words);
  }
  ASSERT_FALSE(stopped.ok());
  EXPECT_EQ(exit_status(stopped.error().code), 130);
  EXPECT_THAT(stopped.error().message, HasSubstr("of 600 frames are whole in " + out.string()));
  EXPECT_THAT(stopped.error().message, HasSubstr("the same command goes on"));
  // Every file that exists is whole, and no other file exists.
  std::size_t whole = 0;
  for (const auto& entry : fs::directory_iterator(out)) {
    EXPECT_TRUE(fs::exists(entry.path() / "sonar.npy")) << entry.path();
    EXPECT_TRUE(fs::exists(entry.path() / "sonar.json")) << entry.path();
    ++whole;
  }
  EXPECT_GT(whole, 3u);
  EXPECT_LT(whole, frames);
  EXPECT_THAT(stopped.error().message, HasSubstr(fmt::format("interrupted: {} of", whole)));
  NERITIC_ASSERT_STATUS(test::sonar_command(words));
  for (std::size_t i = 0; i < frames; ++i)
    ASSERT_TRUE(fs::exists(out / fmt::format("{:04}", i) / "sonar.json")) << i;
}

TEST(Interrupt, ATrackKeepsTheFramesUntilThenAndSaysHowToMakeTheOthers) {
  if (!test::have_device()) GTEST_SKIP() << "no Vulkan device";
  const test::ScratchFolder folder;
  tools::RenderFlags flags;
  flags.scene = (test::source_dir() / "assets/scenes/survey.toml").string();
  flags.sensors = {"sounder"};
  flags.out = (folder / "out").string();
  flags.frames = 100000;
  std::optional<Result<std::string>> done;
  {
    const InterruptWhen at(folder / "out" / "frame_0002" / "sounder" / "sonar.json");
    done = tools::run_render(flags);
  }
  ASSERT_FALSE(done->ok());
  EXPECT_EQ(exit_status(done->error().code), 130);
  const std::string& said = done->error().message;
  EXPECT_THAT(said, HasSubstr("of 100000 frames are in " + flags.out + " as frame_0000 to "));
  EXPECT_THAT(said, HasSubstr("and track, of these frames; --time "));
  EXPECT_TRUE(fs::exists(folder / "out" / "track" / "sounder" / "echo_trace.json"));
  std::size_t frames = 0;
  for (const auto& entry : fs::directory_iterator(folder / "out"))
    frames += entry.path().filename().string().starts_with("frame_");
  EXPECT_THAT(said, HasSubstr(fmt::format("--frames {} ", 100000 - frames)));
}

}  // namespace
}  // namespace neritic
