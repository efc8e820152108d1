// Whole files in and out: nothing but a plain file is ever replaced, links are followed.
#include "engine/core/files.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "engine/core/log.hpp"
#include "tests/support/support.hpp"

namespace neritic {
namespace {

namespace fs = std::filesystem;

std::size_t entries(const fs::path& folder) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(WriteFile, WritesIntoAPipeAndLeavesItAPipe) {
  const test::ScratchFolder folder;
  const fs::path pipe = folder / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const int reader = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_GE(reader, 0);
  const Status written = write_text(pipe, "abc");
  char got[8] = {};
  const auto length = ::read(reader, got, sizeof got);
  ::close(reader);
  EXPECT_TRUE(written.ok());
  EXPECT_TRUE(fs::is_fifo(pipe));
  EXPECT_EQ(std::string(got, static_cast<std::size_t>(std::max<ssize_t>(length, 0))), "abc");
  EXPECT_EQ(entries(folder.path()), 1u);
}

TEST(WriteFile, FollowsLinksToWhatTheyNameAlsoWhereNothingIsThereYet) {
  const test::ScratchFolder folder;
  ASSERT_TRUE(make_folder(folder / "far").ok());
  ASSERT_TRUE(write_text(folder / "far/old", "before").ok());
  fs::create_symlink("far/old", folder / "to_old");
  fs::create_symlink("to_old", folder / "twice");
  fs::create_symlink("far/new", folder / "to_new");
  EXPECT_TRUE(write_text(folder / "twice", "after").ok());
  EXPECT_TRUE(write_text(folder / "to_new", "fresh").ok());
  for (const char* link : {"to_old", "twice", "to_new"})
    EXPECT_TRUE(fs::is_symlink(folder / link)) << link;
  EXPECT_EQ(read_text(folder / "far/old").value(), "after");
  EXPECT_EQ(read_text(folder / "far/new").value(), "fresh");
  EXPECT_EQ(entries(folder / "far"), 2u);
}

TEST(WriteFile, ALoopOfLinksIsAnErrorThatLeavesNothing) {
  const test::ScratchFolder folder;
  fs::create_symlink("b", folder / "a");
  fs::create_symlink("a", folder / "b");
  EXPECT_FALSE(write_text(folder / "a", "x").ok());
  EXPECT_EQ(entries(folder.path()), 2u);
}

TEST(OneLine, WritesControlCharactersOut) {
  EXPECT_EQ(one_line("a\nb\x1b[1m\tü"), "a\\nb\\x1b[1m\\x09ü");
}

}  // namespace
}  // namespace neritic
