// Shared by every test program: where the source tree and the shared real data lie, scratch
// folders.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace neritic::test {

// Whether this build's times say anything: sanitizers take thirty times as long.
#if defined(__SANITIZE_THREAD__) || defined(__SANITIZE_ADDRESS__)
inline constexpr bool kFast = false;
#else
inline constexpr bool kFast = true;
#endif

// The repository's root.
std::filesystem::path source_dir();

// The folder of real data and reference numbers beside the checkout (../shared, or
// $NERITIC_SHARED); nothing where it is absent: such tests report skipped, never passed.
std::optional<std::filesystem::path> shared_dir();

// The name of a parameterised test: its index and the words of a text that says what it is about.
std::string test_name(std::size_t index, std::string_view text);

// A fresh, empty folder for this test's files, removed at its end.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

// Whether statistical tests take all their draws (tools/test --thorough), not a quarter of them.
inline bool is_thorough() {
  const char* value = std::getenv("NERITIC_THOROUGH");
  return value && std::string(value) == "1";
}

}  // namespace neritic::test

// In a test: NERITIC_REQUIRE_SHARED(shared); then shared is the folder.
#define NERITIC_REQUIRE_SHARED(variable)                                       \
  const auto variable##_maybe = ::neritic::test::shared_dir();                 \
  if (!variable##_maybe) GTEST_SKIP() << "no ../shared folder with real data"; \
  const std::filesystem::path& variable = *variable##_maybe
