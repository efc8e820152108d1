// Every kind with every term gives the same bits at every run, on any number of driver threads.
#include <gtest/gtest.h>

#include <cstdlib>

#include "engine/core/files.hpp"
#include "engine/core/hash.hpp"
#include "sonar/write_sonar.hpp"
#include "tests/testbed/sensors/sonar_sea.hpp"

namespace neritic::testbed {
namespace {

using SonarBits = test::GpuTest;

// Where another run of this program shall leave the hash of one run, to be compared.
constexpr const char* kHashFile = "NERITIC_TEST_SONAR_HASH_FILE";

std::string hash_of(const std::vector<SonarFrame>& frames) {
  Hash64 hash;
  for (const SonarFrame& frame : frames) {
    hash.add_span(std::span<const float>(frame.image.intensity));
    hash.add_span(std::span<const std::uint16_t>(frame.image.labels));
    const auto counts = sonar::quantize(frame.image.intensity, frame.terms.output);
    hash.add_span(std::span<const std::uint16_t>(counts));
    if (frame.label_energy) {
      hash.add_span(std::span<const std::uint16_t>(frame.label_energy->classes));
      hash.add_span(std::span<const std::uint16_t>(frame.label_energy->instances));
      hash.add_span(std::span<const float>(frame.label_energy->fraction));
    }
  }
  return hash.hex();
}

// Twenty runs where the test is thorough.
TEST_F(SonarBits, RunsOfEveryTermGiveTheSameBits) {
  std::string all;
  auto cases = other_shapes();
  for (const scene::SonarKind kind : kSonarKinds) cases.emplace_back(kind, every_term());
  for (const auto& [kind, terms] : cases) {
    scene::Sonar sonar = small_sonar(kind);
    sonar.terms = terms;
    FrameRequest request;
    request.sonars = {0};
    request.frame = 5;
    request.capture = request.capture.without_geometry();
    std::string first;
    std::unique_ptr<Session> session;
    const int runs = std::getenv(kHashFile) ? 1 : test::is_thorough() ? 20 : 4;
    for (int run = 0; run < runs; ++run) {
      if (run % 2 == 0) {  // from nothing, then in the memory of the run before
        NERITIC_ASSERT_OK(session, Session::create(device(), some_sea(sonar)));
      }
      NERITIC_ASSERT_OK(const FrameResult result, session->render(request));
      const std::string hash = hash_of(result.sonars);
      if (run == 0) first = hash;
      ASSERT_EQ(hash, first) << scene::name_of(kind) << ", run " << run;
    }
    all += first + " ";
  }
  if (const char* file = std::getenv(kHashFile)) NERITIC_ASSERT_STATUS(write_text(file, all));
}

TEST_F(SonarBits, OneAndTwoThreadsOfTheDriverGiveTheSameBits) {
  if (device().info().name.find("llvmpipe") == std::string::npos)
    GTEST_SKIP() << "the number of threads is llvmpipe's switch";
  const test::ScratchFolder folder;
  std::string hashes[2];
  for (int i = 0; i < 2; ++i) {
    // The driver reads its switch when a device is made: each in a program of its own.
    const std::filesystem::path file = folder / fmt::format("{}", i + 1);
    const std::string command = fmt::format(
        "LP_NUM_THREADS={} {}={} {} --gtest_filter=SonarBits.RunsOf* > {} 2>&1", i + 1, kHashFile,
        file.string(), std::filesystem::read_symlink("/proc/self/exe").string(),
        (folder / "said").string());
    ASSERT_EQ(std::system(command.c_str()), 0) << read_text(folder / "said").value();
    NERITIC_ASSERT_OK(hashes[i], read_text(file));
  }
  EXPECT_FALSE(hashes[0].empty());
  EXPECT_EQ(hashes[0], hashes[1]);
}

}  // namespace
}  // namespace neritic::testbed
