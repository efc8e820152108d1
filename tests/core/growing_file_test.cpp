// Files that grow: what was appended outlives a kill, and no half of a file has its final name.
#include "engine/core/growing_file.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "engine/core/files.hpp"
#include "tests/support/support.hpp"

namespace neritic {
namespace {

namespace fs = std::filesystem;

TEST(GrowingFile, AKilledRunLeavesAllUpToItsLastChunk) {
  const test::ScratchFolder folder;
  const fs::path path = folder / "log.csv";
  ASSERT_TRUE(write_text(path, "an earlier run's").ok());
  const std::string row(99, 'x');
  const pid_t child = ::fork();
  if (child == 0) {
    GrowingFile file(path);
    for (int i = 0; i < 10000; ++i)
      if (!file.append(row + "\n").ok()) ::_exit(1);
    ::raise(SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(read_text(path).value(), "an earlier run's");
  const std::string part = read_text(part_of(path)).value();
  EXPECT_GE(part.size(), 1000000 - GrowingFile::kChunk_bytes);
  EXPECT_EQ(part.size() % 100, 0u);
  EXPECT_EQ(part.substr(part.size() - 100), row + "\n");
}

TEST(GrowingFile, TakesItsNameWhenItIsWholeAndReplacesAnEarlierPart) {
  const test::ScratchFolder folder;
  ASSERT_TRUE(write_text(folder / "a.csv.part", "of a killed run").ok());
  fs::create_symlink("a.csv", folder / "link.csv");
  for (const char* name : {"a.csv", "link.csv"}) {
    GrowingFile file(folder / name);
    ASSERT_TRUE(file.append(std::string(GrowingFile::kChunk_bytes, 'a')).ok());
    EXPECT_TRUE(fs::exists(folder / "a.csv.part"));
    ASSERT_TRUE(file.append("b").ok());
    ASSERT_TRUE(file.finish().ok());
    EXPECT_FALSE(fs::exists(folder / "a.csv.part"));
    EXPECT_EQ(read_text(folder / name).value(), std::string(GrowingFile::kChunk_bytes, 'a') + "b");
  }
  EXPECT_TRUE(fs::is_symlink(folder / "link.csv"));
  GrowingFile empty(folder / "empty");
  EXPECT_TRUE(empty.finish().ok());
  EXPECT_EQ(fs::file_size(folder / "empty"), 0u);
}

TEST(GrowingFile, OneThatIsClaimedIsWrittenByNobodyElse) {
  const test::ScratchFolder folder;
  const fs::path path = folder / "a.mcap";
  ASSERT_TRUE(write_text(part_of(path), "of a killed run").ok());
  EXPECT_FALSE(being_written(path));
  {
    GrowingFile file(path), other(path);
    ASSERT_TRUE(file.claim().ok());
    EXPECT_TRUE(being_written(path));
    ASSERT_TRUE(file.append(std::string_view("one")).ok());
    ASSERT_TRUE(file.flush().ok());
    const Status refused = other.claim();
    ASSERT_FALSE(refused.ok());
    EXPECT_NE(refused.error().message.find("another program writes"), std::string::npos)
        << refused.error().message;
    EXPECT_FALSE(other.append(std::string_view("two")).ok());
    EXPECT_FALSE(other.finish().ok());
    keep_old(path);
    ASSERT_TRUE(file.finish().ok());
  }
  EXPECT_EQ(read_text(path).value(), "one");
  EXPECT_EQ(std::distance(fs::directory_iterator(path.parent_path()), {}), 1);
  EXPECT_FALSE(being_written(path));
  GrowingFile again(path);
  EXPECT_TRUE(again.claim().ok());
}

// The limit of a file's size stands for a disk that fills.
TEST(GrowingFile, AFullDiskLeavesWholeRowsAndSaysWhere) {
  const test::ScratchFolder folder;
  const fs::path path = folder / "rows.csv";
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit small{GrowingFile::kChunk_bytes * 5 / 2 + 13, before.rlim_max};
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const std::string row = std::string(98, 'x') + ";\n";
  GrowingFile file(path);
  Status status;
  for (int i = 0; i < 20000 && status.ok(); ++i) status = file.append(row);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, handler);
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().message,
            fmt::format("{0}: cannot be written whole (disk full?); what was written before is in "
                        "{0}.part",
                        path.string()));
  const std::string part = read_text(part_of(path)).value();
  EXPECT_EQ(part.size(), small.rlim_cur / row.size() * row.size());
  EXPECT_FALSE(fs::exists(path));
}

TEST(GrowingFile, WritesADeviceAsItStandsAndSaysWhatCannotBeWritten) {
  const test::ScratchFolder folder;
  GrowingFile device("/dev/null");
  EXPECT_TRUE(device.append(std::string(2 * GrowingFile::kChunk_bytes, 'x')).ok());
  EXPECT_TRUE(device.finish().ok());
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  GrowingFile full("/dev/full");
  const Status status = full.append(std::string(2 * GrowingFile::kChunk_bytes, 'x'));
  ASSERT_FALSE(status.ok());
  EXPECT_NE(status.error().message.find("/dev/full: cannot be written whole"), std::string::npos);
  GrowingFile nowhere(folder / "no/folder/x");
  EXPECT_FALSE(nowhere.finish().ok());
}

}  // namespace
}  // namespace neritic
