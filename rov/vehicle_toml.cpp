// The only file of this folder that compiles toml++ (header-only; its errors are values here).
#define TOML_HEADER_ONLY 1
// toml++ 3.3 asserts, and with NDEBUG assumes, what a wrong file can break ("[=]"): a failed
// assertion must become an error of the file. It is thrown to try_parse_toml() and goes no farther.
#undef NDEBUG
namespace neritic::rov {
namespace {
struct TomlGaveUp {};
[[noreturn]] void toml_gives_up() {
  throw TomlGaveUp();
}
}  // namespace
}  // namespace neritic::rov
#define TOML_ASSERT(expression) \
  ((expression) ? static_cast<void>(0) : ::neritic::rov::toml_gives_up())
#define TOML_EXCEPTIONS 0
#define TOML_ENABLE_FORMATTERS 0
#define TOML_MAX_NESTED_VALUES 32
#include "rov/vehicle_toml.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "engine/core/files.hpp"

namespace neritic::rov {
namespace {

constexpr std::size_t kMostBytes = std::size_t{1} << 20;
// Each dot of a key nests a table, and tables are destroyed recursively.
constexpr std::ptrdiff_t kMostDots = 10000;
constexpr int kMostIncludes = 8;

std::string on_one_line(std::string_view text) {
  std::string line(text.substr(0, 200));
  for (char& c : line)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  return line;
}

std::optional<toml::parse_result> try_parse_toml(std::string_view text) {
  try {
    return toml::parse(text);
  } catch (const TomlGaveUp&) {
    return std::nullopt;
  }
}

nlohmann::json tree_of(const toml::node& node) {
  if (const auto* table = node.as_table()) {
    nlohmann::json out = nlohmann::json::object();
    for (const auto& [key, child] : *table) out[std::string(key.str())] = tree_of(child);
    return out;
  }
  if (const auto* array = node.as_array()) {
    nlohmann::json out = nlohmann::json::array();
    for (const toml::node& child : *array) out.push_back(tree_of(child));
    return out;
  }
  if (const auto* text = node.as_string()) return text->get();
  if (const auto* boolean = node.as_boolean()) return boolean->get();
  if (const auto* integer = node.as_integer()) return integer->get();
  if (const auto* number = node.as_floating_point()) {
    if (std::isfinite(number->get())) return number->get();
    return std::isnan(number->get()) ? "nan" : "inf";  // a text where a number is accepted
  }
  return "a date or time";
}

// Keys of over win; tables are merged key by key.
void merge(nlohmann::json& under, const nlohmann::json& over) {
  for (auto it = over.begin(); it != over.end(); ++it) {
    const auto there = under.find(it.key());
    if (there != under.end() && there->is_object() && it->is_object())
      merge(*there, *it);
    else
      under[it.key()] = *it;
  }
}

// The file's tree over that of the file it includes, and so on.
Result<nlohmann::json> read_tree(std::string_view text, const std::string& name,
                                 const std::filesystem::path& folder, int depth) {
  if (text.size() > kMostBytes || std::ranges::count(text, '.') > kMostDots ||
      text.find('\0') != text.npos)
    return bad_input("{}: no vehicle; up to 1 MiB of text without zero bytes is accepted", name);
  const auto parsed = try_parse_toml(text);
  if (!parsed)
    return bad_input("{}: not TOML: a key, a value or a table's name in brackets is expected",
                     name);
  if (!*parsed)
    return bad_input("{}:{}: not TOML: {}", name, parsed->error().source().begin.line,
                     on_one_line(parsed->error().description()));
  nlohmann::json own = tree_of(parsed->table());
  // Paths are relative to the file that they are written in.
  if (const auto table = own.find("thrust_table"); table != own.end() && table->is_string())
    *table = (folder / table->get<std::string>()).string();
  const auto include = own.find("include");
  if (include == own.end()) return own;
  if (!include->is_string()) return bad_input("{}: include: the name of a file is accepted", name);
  if (depth == kMostIncludes)
    return bad_input("{}: include: files nested deeper than {} found", name, depth);
  const std::filesystem::path path = folder / include->get<std::string>();
  own.erase(include);
  NERITIC_TRY(const std::string base, read_text(path));
  NERITIC_TRY(nlohmann::json under, read_tree(base, path.string(), path.parent_path(), depth + 1));
  merge(under, own);
  return under;
}

}  // namespace

Result<CaseFile> parse_vehicle_toml(std::string_view text, const std::string& name,
                                    const std::filesystem::path& folder) {
  NERITIC_TRY(nlohmann::json tree, read_tree(text, name, folder, 0));
  return CaseFile(std::move(tree), name);
}

}  // namespace neritic::rov
