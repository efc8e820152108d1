// The only file that compiles toml++ (header-only; its errors are values here, not exceptions).
#define TOML_HEADER_ONLY 1
// toml++ 3.3 asserts, and with NDEBUG assumes, what a wrong file can break ("[=]"): a failed
// assertion must become an error of the file. It is thrown to try_parse() and goes no farther.
#undef NDEBUG
namespace neritic::scene {
namespace {
struct ParserGaveUp {};
[[noreturn]] void give_up() {
  throw ParserGaveUp();
}
}  // namespace
}  // namespace neritic::scene
#define TOML_ASSERT(expression) ((expression) ? static_cast<void>(0) : ::neritic::scene::give_up())
#define TOML_EXCEPTIONS 0
#define TOML_ENABLE_FORMATTERS 0
#define TOML_MAX_NESTED_VALUES 32
#include "engine/scene/scene_toml.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <optional>

#include "engine/scene/scene_text.hpp"

namespace neritic::scene {
namespace {

// Each dot of a key nests a table, and tables are destroyed recursively: a line with more dots than
// this could overflow the stack. Far above what a person writes; long lists belong in a .csv.
constexpr int kMaxDotsInLine = 400;

TomlValue convert(const toml::node& node, int file);

TomlValue convert_table(const toml::table& table, int file) {
  TomlValue out;
  for (const auto& [key, child] : table) {
    const auto line = static_cast<int>(key.source().begin.line);
    out.entries.push_back({std::string(key.str()), {file, line}, convert(child, file)});
  }
  return out;
}

TomlValue convert(const toml::node& node, int file) {
  TomlValue out;
  if (const auto* table = node.as_table()) {
    out = convert_table(*table, file);
  } else if (const auto* array = node.as_array()) {
    out.kind = TomlValue::Kind::kArray;
    out.items.reserve(array->size());
    for (const toml::node& child : *array) out.items.push_back(convert(child, file));
  } else if (const auto* boolean = node.as_boolean()) {
    out.kind = TomlValue::Kind::kBool;
    out.boolean = boolean->get();
  } else if (const auto* integer = node.as_integer()) {
    out.kind = TomlValue::Kind::kInteger;
    out.integer = integer->get();
    out.number = static_cast<double>(out.integer);
  } else if (const auto* number = node.as_floating_point()) {
    out.kind = TomlValue::Kind::kNumber;
    out.number = number->get();
  } else if (const auto* text = node.as_string()) {
    out.kind = TomlValue::Kind::kString;
    out.text = text->get();
  } else {
    out.kind = TomlValue::Kind::kDate;
  }
  out.where = {file, static_cast<int>(node.source().begin.line)};
  return out;
}

Status check_lines(std::string_view text, const std::string& file_name) {
  int line = 1, dots = 0;
  for (const char c : text) {
    if (c == '\0') return bad_input("{}:{}: not TOML: a zero byte", file_name, line);
    if (c == '\n' || c == '\r') {
      line += c == '\n';
      dots = 0;
    } else if (c == '.' && ++dots > kMaxDotsInLine) {
      return bad_input(
          "{}:{}: more than {} dots in a line; accepted: long lists over several lines", file_name,
          line, kMaxDotsInLine);
    }
  }
  return {};
}

// The parser's result; nothing where it met text that it has no error for.
std::optional<toml::parse_result> try_parse(std::string_view text) {
  try {
    return toml::parse(text);
  } catch (const ParserGaveUp&) {
    return std::nullopt;
  }
}

// The line at which try_parse gives up: it reads from the front, so it gives up on every beginning
// of the text that holds that line, and on none that does not.
int line_of_giving_up(std::string_view text) {
  std::vector<std::size_t> line_ends;
  for (std::size_t i = 0; i < text.size(); ++i)
    if (text[i] == '\n') line_ends.push_back(i + 1);
  const auto first = std::partition_point(line_ends.begin(), line_ends.end(), [&](std::size_t end) {
    return try_parse(text.substr(0, end)).has_value();
  });
  return static_cast<int>(first - line_ends.begin()) + 1;
}

}  // namespace

bool TomlValue::is_table_array() const {
  return kind == Kind::kArray && !items.empty() &&
         std::all_of(items.begin(), items.end(), [](const TomlValue& v) { return v.is_table(); });
}

const TomlEntry* TomlValue::find(std::string_view key) const {
  const auto at = std::find_if(entries.begin(), entries.end(),
                               [key](const TomlEntry& entry) { return entry.key == key; });
  return at == entries.end() ? nullptr : &*at;
}

TomlEntry* TomlValue::find(std::string_view key) {
  return const_cast<TomlEntry*>(std::as_const(*this).find(key));
}

std::string describe(const TomlValue& value) {
  switch (value.kind) {
    case TomlValue::Kind::kBool:
      return value.boolean ? "true" : "false";
    case TomlValue::Kind::kInteger:
      return fmt::format("{}", value.integer);
    case TomlValue::Kind::kNumber:
      return fmt::format("{}", value.number);
    case TomlValue::Kind::kString:
      return fmt::format("\"{}\"", printable(value.text));
    case TomlValue::Kind::kDate:
      return "a date or time";
    case TomlValue::Kind::kTable:
      return "a table";
    case TomlValue::Kind::kArray:
      break;
  }
  std::string out = "[";
  for (const TomlValue& item : value.items) {
    if (out.size() > 60) return out + ", ...]";
    if (out.size() > 1) out += ", ";
    out += item.kind == TomlValue::Kind::kArray ? "[...]" : describe(item);
  }
  return out + "]";
}

Result<TomlValue> parse_toml(std::string_view text, const std::string& file_name, int file) {
  NERITIC_TRY_STATUS(check_lines(text, file_name));
  const std::optional<toml::parse_result> parsed = try_parse(text);
  if (!parsed)
    return bad_input("{}:{}: not TOML: a key, a value or a table's name in brackets is expected",
                     file_name, line_of_giving_up(text));
  if (!*parsed) {
    const toml::parse_error& error = parsed->error();
    return bad_input("{}:{}: not TOML: {}", file_name, error.source().begin.line,
                     printable(error.description(), 200));
  }
  return convert_table(parsed->table(), file);
}

}  // namespace neritic::scene
