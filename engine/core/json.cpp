#include "engine/core/json.hpp"

#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/core/files.hpp"
#include "engine/core/refusal.hpp"

namespace neritic {
namespace {

// Deepest nesting of brackets outside strings.
int nesting_of(std::string_view text) {
  int depth = 0, deepest = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '{' || c == '[') {
      deepest = std::max(deepest, ++depth);
    } else if (c == '}' || c == ']') {
      --depth;
    }
  }
  return deepest;
}

void tidy(nlohmann::json& value) {
  if (value.is_number_float()) value = tidy_number(value.get<double>());
  if (!value.is_structured()) return;
  for (nlohmann::json& part : value) tidy(part);
}

}  // namespace

Result<nlohmann::json> parse_json(std::string_view text) {
  if (const int depth = nesting_of(text); depth > kMaxJsonNesting)
    return refusal("", fmt::format("JSON nested {} deep", depth),
                   fmt::format("at most {}", kMaxJsonNesting));
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::exception& exception) {
    // "[json.exception.parse_error.101] parse error at line 1, column 2: ..."
    std::string_view what = exception.what();
    if (const auto end = what.find("] "); end != what.npos) what.remove_prefix(end + 2);
    return bad_input("{}", what);
  }
}

double tidy_number(double value) {
  if (!std::isfinite(value)) return value;
  char text[32];
  const float as_float = static_cast<float>(value);
  const auto written =
      static_cast<double>(as_float) == value
          ? std::to_chars(text, std::end(text), as_float)
          : std::to_chars(text, std::end(text), value, std::chars_format::general, 15);
  double out = value;
  std::from_chars(text, written.ptr, out);
  return out;
}

std::string json_text(const nlohmann::json& value, int indent) {
  nlohmann::json copy = value;
  tidy(copy);
  return copy.dump(indent, ' ', false, nlohmann::json::error_handler_t::replace);
}

Status write_json(const std::filesystem::path& path, const nlohmann::json& value) {
  return write_text(path, json_text(value) + "\n");
}

}  // namespace neritic
