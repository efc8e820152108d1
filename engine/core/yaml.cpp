// See yaml.hpp. Lines are cut from comments and indentation first; a value in brackets that goes on
// over several lines is joined to one.
#include "engine/core/yaml.hpp"

#include <charconv>
#include <nlohmann/json.hpp>

#include "engine/core/json.hpp"
#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"

namespace neritic {
namespace {

using Json = nlohmann::json;

struct Line {
  std::size_t number = 0, indent = 0;
  std::string text;  // without indentation, comment and spaces at the end
};

Error refuse(std::size_t line, std::string_view found, std::string_view accepted) {
  return refusal(fmt::format("line {}", line), fmt::format("'{}'", printable(found, 40)), accepted);
}

bool is_space(char c) {
  return c == ' ' || c == '\t';
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

// The state after a part of a text. Quotes begin a scalar; within a word they are letters.
struct Scan {
  char quote = 0;
  int depth = 0;  // of brackets
  bool begins = true;
};

// Calls visit(position, depth of brackets) for each character outside of quotes, until that
// returns false. Gives the state there. before: of the text that this one follows on.
template <class Visit>
Scan each_plain(std::string_view text, Visit&& visit, const Scan& before = {}) {
  Scan scan = before;
  auto& [quote, depth, begins] = scan;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quote != 0) {
      if (c == '\\' && quote == '"') ++i;
      if (c == quote) quote = 0;
      continue;
    }
    if (begins && (c == '"' || c == '\'')) {
      quote = c;
      continue;
    }
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') --depth;
    begins = is_space(c) || c == '[' || c == '{' || c == ',' || c == ':';
    if (!visit(i, depth)) break;
  }
  return scan;
}

std::string_view without_comment(std::string_view line) {
  std::size_t end = line.size();
  each_plain(line, [&](std::size_t i, int) {
    if (line[i] != '#' || (i > 0 && !is_space(line[i - 1]))) return true;
    end = i;
    return false;
  });
  line = line.substr(0, end);
  while (!line.empty() && is_space(line.back())) line.remove_suffix(1);
  return line;
}

Scan scan_of(std::string_view text, const Scan& before = {}) {
  return each_plain(
      text, [](std::size_t, int) { return true; }, before);
}

// Where the ':' between key and value stands, npos where there is none.
std::size_t key_end(std::string_view text) {
  std::size_t end = text.npos;
  each_plain(text, [&](std::size_t i, int depth) {
    if (depth != 0 || text[i] != ':' || (i + 1 < text.size() && !is_space(text[i + 1])))
      return true;
    end = i;
    return false;
  });
  return end;
}

Result<std::vector<Line>> lines_of(std::string_view text) {
  std::vector<Line> out;
  Scan scan;  // of the last line of out
  std::size_t number = 0;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    text = end == text.npos ? std::string_view{} : text.substr(end + 1);
    ++number;
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    line = without_comment(line);
    if (line.empty() || line.front() == '%') continue;
    if (line == "..." || (line == "---" && !out.empty())) break;  // the next document
    if (line == "---") continue;
    std::size_t indent = 0;
    while (line[indent] == ' ') ++indent;
    if (line[indent] == '\t') return refuse(number, "a tab", "spaces to indent");
    line = trimmed(line);
    if (scan.depth > 0) {
      (out.back().text += ' ') += line;
      scan.begins = true;  // after the space
      scan = scan_of(line, scan);
    } else {
      out.push_back({number, indent, std::string(line)});
      scan = scan_of(line);
    }
  }
  return out;
}

class Parser {
 public:
  explicit Parser(std::vector<Line> lines) : lines_(std::move(lines)) {}

  Result<Json> run() {
    if (lines_.empty()) return Json();
    NERITIC_TRY(Json out, block(lines_[0].indent, 0));
    if (at_ < lines_.size())
      return refuse(here().number, here().text, "a line indented like those before");
    return out;
  }

 private:
  const Line& here() const { return lines_[at_]; }
  bool inside(std::size_t indent) const { return at_ < lines_.size() && here().indent == indent; }
  static bool is_item(std::string_view text) { return text == "-" || text.starts_with("- "); }

  // The map, list or scalar whose lines begin at that indentation.
  Result<Json> block(std::size_t indent, int depth) {
    if (depth > kMaxJsonNesting) return refuse(here().number, here().text, "shallower nesting");
    if (is_item(here().text)) return list(indent, depth);
    if (key_end(here().text) != std::string::npos) return map(indent, depth);
    const Line line = here();
    ++at_;
    return value(line.text, line.number, depth);
  }

  Result<Json> list(std::size_t indent, int depth) {
    Json out = Json::array();
    while (inside(indent) && is_item(here().text)) {
      const std::string_view text = here().text;
      std::size_t skip = 1;
      while (skip < text.size() && is_space(text[skip])) ++skip;
      if (skip == text.size()) {
        NERITIC_TRY(Json item, below(indent, depth));
        out.push_back(std::move(item));
        continue;
      }
      // The text behind the dash is a block of its own, indented by it.
      lines_[at_].text = std::string(text.substr(skip));
      lines_[at_].indent = indent + skip;
      NERITIC_TRY(Json item, block(indent + skip, depth + 1));
      out.push_back(std::move(item));
    }
    return out;
  }

  Result<Json> map(std::size_t indent, int depth) {
    Json out = Json::object();
    while (inside(indent) && !is_item(here().text)) {
      const Line line = here();
      const std::size_t end = key_end(line.text);
      if (end == std::string::npos) return refuse(line.number, line.text, "KEY: VALUE");
      NERITIC_TRY(const Json key,
                  scalar(trimmed(std::string_view(line.text).substr(0, end)), line.number, true));
      std::string_view rest = without_tag(std::string_view(line.text).substr(end + 1));
      Json found;
      if (rest.empty()) {
        NERITIC_TRY(found, below(indent, depth));
      } else {
        ++at_;
        NERITIC_TRY(found, value(rest, line.number, depth));
      }
      if (!out.emplace(key.get<std::string>(), std::move(found)).second)
        return refuse(line.number, key.get<std::string>(), "each key once");
    }
    return out;
  }

  // The block that is indented below the present line, or null. A list may stand level with its
  // key.
  Result<Json> below(std::size_t indent, int depth) {
    const bool item = is_item(here().text);
    ++at_;
    if (at_ == lines_.size()) return Json();
    const bool level = here().indent == indent && is_item(here().text) && !item;
    if (here().indent <= indent && !level) return Json();
    return block(here().indent, depth + 1);
  }

  static std::string_view without_tag(std::string_view text) {
    text = trimmed(text);
    if (text.empty() || text.front() != '!') return text;
    while (!text.empty() && !is_space(text.front())) text.remove_prefix(1);
    return trimmed(text);
  }

  // A scalar, or a list or map in brackets that fills the text.
  static Result<Json> value(std::string_view text, std::size_t line, int depth) {
    text = without_tag(text);
    if (depth > kMaxJsonNesting) return refuse(line, text, "shallower nesting");
    if (text.empty()) return Json();
    const char open = text.front();
    if (open != '[' && open != '{') return scalar(text, line, false);
    if (scan_of(text).depth != 0 || text.back() != (open == '[' ? ']' : '}'))
      return refuse(line, text, "brackets that close");
    const std::string_view inner = text.substr(1, text.size() - 2);
    Json out = open == '[' ? Json::array() : Json::object();
    for (const std::string_view part : parts_of(inner)) {
      if (open == '[') {
        NERITIC_TRY(Json item, value(part, line, depth + 1));
        out.push_back(std::move(item));
        continue;
      }
      const std::size_t end = key_end(part);
      if (end == part.npos) return refuse(line, part, "KEY: VALUE");
      NERITIC_TRY(const Json key, scalar(trimmed(part.substr(0, end)), line, true));
      NERITIC_TRY(Json item, value(part.substr(end + 1), line, depth + 1));
      out[key.get<std::string>()] = std::move(item);
    }
    return out;
  }

  // Between the commas; what is empty after the last one is none.
  static std::vector<std::string_view> parts_of(std::string_view text) {
    std::vector<std::string_view> out;
    std::size_t from = 0;
    each_plain(text, [&](std::size_t i, int depth) {
      if (text[i] != ',' || depth != 0) return true;
      out.push_back(trimmed(text.substr(from, i - from)));
      from = i + 1;
      return true;
    });
    if (const auto last = trimmed(text.substr(from)); !last.empty()) out.push_back(last);
    return out;
  }

  static Result<Json> scalar(std::string_view text, std::size_t line, bool as_text) {
    if (text.empty()) return as_text ? Result<Json>(Json("")) : Json();
    const char first = text.front();
    if (first == '"' || first == '\'') {
      if (text.size() < 2 || text.back() != first) return refuse(line, text, "quotes that close");
      return Json(std::string(text.substr(1, text.size() - 2)));
    }
    if (first == '&' || first == '*' || first == '|' || first == '>' || first == '@' ||
        first == '`')
      return refuse(line, text, "plain values: no anchors, aliases or blocks of text");
    if (as_text) return Json(std::string(text));
    if (text == "true" || text == "false") return Json(text == "true");
    if (text == "null" || text == "~") return Json();
    std::string_view digits = text;
    if (digits.size() > 1 && digits.front() == '+') digits.remove_prefix(1);
    std::uint64_t whole = 0;
    double number = 0.0;
    const char* end = digits.data() + digits.size();
    if (const auto r = std::from_chars(digits.data(), end, whole);
        r.ec == std::errc() && r.ptr == end)
      return Json(whole);
    if (const auto r = std::from_chars(digits.data(), end, number);
        r.ec == std::errc() && r.ptr == end && std::isfinite(number))
      return Json(number);
    return Json(std::string(text));
  }

  std::vector<Line> lines_;
  std::size_t at_ = 0;
};

}  // namespace

Result<Json> parse_yaml(std::string_view text) {
  NERITIC_TRY(std::vector<Line> lines, lines_of(text));
  return Parser(std::move(lines)).run();
}

}  // namespace neritic
