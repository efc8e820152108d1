// Unity builds compile up to sixty files of a folder as one, so that the anonymous namespaces of
// all files of a folder must share no names. Which files meet changes with every new file.
#include <gtest/gtest.h>

#include <map>
#include <regex>
#include <set>

#include "engine/core/files.hpp"
#include "tests/support/support.hpp"

namespace neritic {
namespace {

namespace fs = std::filesystem;

// A name that a line of an anonymous namespace declares, and what must be equal for two to agree:
// the whole line of an alias, nothing for types and constants.
struct Declared {
  std::string name;
  std::string agrees;
};

std::vector<Declared> declared_in(const std::string& line) {
  static const std::regex alias(R"(^using (\w+) = (.*))");
  static const std::regex type(R"(^(?:struct|class|enum class|enum|union) (\w+)[ {:].*)");
  static const std::regex constant(
      R"(^(?:inline |static )?(?:constexpr|const) [\w:<>, *]*?(\w+)(?:\[[^\]]*\])*(?: =| ?\{).*)");
  std::smatch found;
  if (std::regex_match(line, found, alias)) return {{found[1], found[2]}};
  if (std::regex_match(line, found, type) && line.back() != ';') return {{found[1], ""}};
  if (!std::regex_match(line, found, constant)) return {};
  std::vector<Declared> all{{found[1], ""}};
  static const std::regex further(R"(, (\w+) = )");
  for (std::sregex_iterator next(line.begin(), line.end(), further), end; next != end; ++next)
    all.push_back({(*next)[1], ""});
  return all;
}

// Types, aliases and constants of the anonymous namespaces of a file, by name.
std::map<std::string, std::string> names_of(const std::string& text) {
  std::map<std::string, std::string> names;
  std::istringstream lines(text);
  bool inside = false;
  for (std::string line; std::getline(lines, line);) {
    if (line == "namespace {") inside = true;
    if (line == "}  // namespace") inside = false;
    const bool alias_anywhere = line.starts_with("using ");
    if (!inside && !alias_anywhere) continue;
    for (const Declared& declared : declared_in(line)) names[declared.name] = declared.agrees;
  }
  return names;
}

// A line for each name that two texts of one folder declare differently.
std::vector<std::string> clashes(const std::map<std::string, std::string>& texts_by_file) {
  std::map<std::string, std::pair<std::string, std::string>> first;  // by name: file, agreement
  std::vector<std::string> found;
  for (const auto& [file, text] : texts_by_file)
    for (const auto& [name, agrees] : names_of(text)) {
      const auto [at, is_new] = first.try_emplace(name, file, agrees);
      if (!is_new && (agrees.empty() || at->second.second != agrees))
        found.push_back(name + ": " + at->second.first + " and " + file);
    }
  return found;
}

TEST(UnityNames, NoTwoFilesOfAFolderDeclareOneNameInTheirAnonymousNamespaces) {
  std::map<fs::path, std::map<std::string, std::string>> folders;
  for (const char* top : {"engine", "sonar", "diver", "rov", "hud", "testbed", "tools", "tests"})
    for (const auto& entry : fs::recursive_directory_iterator(test::source_dir() / top)) {
      if (entry.path().extension() != ".cpp") continue;
      if (entry.path().parent_path().filename() == "fuzz") continue;  // a program each
      folders[entry.path().parent_path()][entry.path().filename()] =
          read_text(entry.path()).value();
    }
  EXPECT_GT(folders.size(), 30u);
  for (const auto& [folder, texts] : folders)
    for (const std::string& clash : clashes(texts)) ADD_FAILURE() << folder << ": " << clash;
}

TEST(UnityNames, FindsConstantsTypesAndAliasesThatDiffer) {
  const std::string head = "namespace n {\nnamespace {\n", end = "}  // namespace\n}\n";
  const auto of = [&](const std::string& one, const std::string& other) {
    return clashes({{"a.cpp", head + one + "\n" + end}, {"b.cpp", head + other + "\n" + end}});
  };
  EXPECT_EQ(of("constexpr double kMost = 3;", "const std::size_t kMost{4};").size(), 1u);
  EXPECT_EQ(of("constexpr int kOne = 1, kTwo = 2;", "constexpr int kTwo = 3;").size(), 1u);
  EXPECT_EQ(of("struct Run {", "struct Run : Base {").size(), 1u);
  EXPECT_EQ(of("using Names = A;", "using Names = B;").size(), 1u);
  EXPECT_TRUE(of("using Json = A;", "using Json = A;").empty());
  EXPECT_TRUE(of("struct Run;", "struct Run {").empty());
  EXPECT_TRUE(of("  const int inner = 3;", "const int inner = 4;").empty());
}

}  // namespace
}  // namespace neritic
