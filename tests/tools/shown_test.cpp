// Each test that a page of claims names exists.
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>

#include "engine/core/files.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/support/support.hpp"

namespace neritic {
namespace {

namespace fs = std::filesystem;

// All of tests/, as "(Suite, Name)".
std::string test_sources() {
  std::string all;
  for (const auto& entry : fs::recursive_directory_iterator(test::source_dir() / "tests"))
    if (entry.path().extension() == ".cpp")
      if (const auto text = read_text(entry.path()); text.ok()) all += *text;
  return all;
}

class ShownPage : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Pages, ShownPage,
                         ::testing::Values("engine/SHOWN.md", "sonar/SHOWN.md", "diver/CHECKS.md"));

TEST_P(ShownPage, NamesTestsThatAreThere) {
  NERITIC_ASSERT_OK(const std::string page, read_text(test::source_dir() / GetParam()));
  const std::string sources = test_sources();
  // `Suite.Name`, `Sonar/Suite.Name`, `test_tools Suite.Name`, or `.Name` of the suite before it.
  // A name that ends in dots or a star stands for all that begin so.
  const std::regex name(R"(`(?:\w+[/ ])?([A-Z]\w*)?\.([A-Z]\w*|\*)(\.\.\.)?`)");
  std::string suite;
  int found = 0;
  for (std::sregex_iterator at(page.begin(), page.end(), name), end; at != end; ++at, ++found) {
    const std::smatch& match = *at;
    if (match[1].matched) suite = match[1];
    std::string wanted = "(" + suite + ", ";
    if (match[2] != "*") wanted += match[2].str() + (match[3].matched ? "" : ")");
    EXPECT_NE(sources.find(wanted), std::string::npos) << match[0];
  }
  EXPECT_GT(found, 50);
}

}  // namespace
}  // namespace neritic
