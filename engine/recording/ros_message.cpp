#include "engine/recording/ros_message.hpp"

#include <algorithm>
#include <charconv>
#include <limits>
#include <map>

#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"
#include "engine/recording/cdr.hpp"

namespace neritic::recording {
namespace {

constexpr std::size_t kMostColumns = 4096, kMostTypes = 256, kMostFields = 1024, kDeepest = 16;
constexpr std::size_t kWidestArray = 64;        // of which each item has a column
constexpr std::size_t kMostNumbers = 1u << 26;  // of a list
constexpr std::size_t kMostArray = 1u << 20;

bool is_name(std::string_view name) {
  return !name.empty() && name.size() <= 255 && std::ranges::all_of(name, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  });
}

}  // namespace

// Reads the definitions: the message's, then "MSG: pkg/Type" after a line of '='.
class RosMessage::Parser {
 public:
  Parser(const McapSchema& schema, RosMessage& out) : schema_(schema), out_(out) {}

  Status run() {
    out_.types_.push_back({schema_.name, {}});
    std::string_view text = schema_.data;
    bool heading = false;  // the next line names a type
    while (!text.empty()) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      std::string_view line = text.substr(0, end);
      text.remove_prefix(std::min(end + 1, text.size()));
      line = {line.begin(), std::ranges::find(line, '#')};
      while (!line.empty() && (line.back() == ' ' || line.back() == '\r' || line.back() == '\t'))
        line.remove_suffix(1);
      while (!line.empty() && (line.front() == ' ' || line.front() == '\t')) line.remove_prefix(1);
      if (line.empty()) continue;
      if (line.starts_with("==")) {
        heading = true;
      } else if (heading) {
        heading = false;
        if (!line.starts_with("MSG: ") || out_.types_.size() >= kMostTypes)
          return refuse(line, "MSG: and the name of a type");
        out_.types_.push_back({std::string(line.substr(5)), {}});
      } else {
        NERITIC_TRY_STATUS(field(line));
      }
    }
    return link();
  }

 private:
  Error refuse(std::string_view found, std::string_view accepted) const {
    return refusal(printable(schema_.name), fmt::format("'{}'", printable(found)), accepted);
  }

  Status field(std::string_view line) {
    const std::size_t space = line.find_first_of(" \t");
    if (space == line.npos) return refuse(line, "a type and a name");
    std::string_view type = line.substr(0, space), rest = line.substr(space);
    while (!rest.empty() && (rest.front() == ' ' || rest.front() == '\t')) rest.remove_prefix(1);
    std::string_view name = rest.substr(0, rest.find_first_of(" \t="));
    // "uint8 ULTRASOUND=0", "string NAME = 'x'": a constant takes no bytes.
    const std::string_view behind = rest.substr(name.size());
    const std::size_t sign = behind.find_first_not_of(" \t");
    if (sign != behind.npos && behind[sign] == '=') return {};
    if (!is_name(name)) return refuse(line, "a type and a name");
    Field field;
    field.name = name;
    if (const std::size_t bracket = type.find('['); bracket != type.npos) {
      if (type.back() != ']') return refuse(line, "an array like float64[9] or float32[]");
      std::string_view count = type.substr(bracket + 1, type.size() - bracket - 2);
      field.many = true;
      if (!count.empty() && !count.starts_with("<=")) {
        const auto [last, error] =
            std::from_chars(count.data(), count.data() + count.size(), field.count);
        if (error != std::errc() || last != count.data() + count.size() || field.count == 0 ||
            field.count > kMostArray)
          return refuse(line, "an array like float64[9] or float32[]");
      }
      type = type.substr(0, bracket);
    }
    static const std::map<std::string_view, Kind> kKinds{
        {"bool", Kind::kBool},       {"byte", Kind::kUint8},    {"char", Kind::kUint8},
        {"int8", Kind::kInt8},       {"uint8", Kind::kUint8},   {"int16", Kind::kInt16},
        {"uint16", Kind::kUint16},   {"int32", Kind::kInt32},   {"uint32", Kind::kUint32},
        {"int64", Kind::kInt64},     {"uint64", Kind::kUint64}, {"float32", Kind::kFloat32},
        {"float64", Kind::kFloat64}, {"string", Kind::kText}};
    const std::string_view plain = type.substr(0, type.find('<'));  // string<=10
    if (const auto known = kKinds.find(plain); known != kKinds.end()) {
      field.kind = known->second;
    } else {
      field.kind = Kind::kStruct;
      wanted_.push_back(
          {out_.types_.size() - 1, out_.types_.back().fields.size(), std::string(type)});
    }
    if (out_.types_.back().fields.size() >= kMostFields)
      return refuse(line, fmt::format("up to {} fields", kMostFields));
    out_.types_.back().fields.push_back(std::move(field));
    return {};
  }

  // "Header", "std_msgs/Header" and "std_msgs/msg/Header" name the same type.
  Status link() {
    const auto last_part = [](std::string_view name) {
      const std::size_t slash = name.rfind('/');
      return slash == name.npos ? name : name.substr(slash + 1);
    };
    for (const Wanted& wanted : wanted_) {
      std::size_t found = 0;
      for (std::size_t i = 1; i < out_.types_.size() && found == 0; ++i)
        if (out_.types_[i].name == wanted.type) found = i;
      for (std::size_t i = 1; i < out_.types_.size() && found == 0; ++i)
        if (last_part(out_.types_[i].name) == last_part(wanted.type)) found = i;
      // One without fields takes no bytes, so that no count of them would be too large.
      if (found == 0 || out_.types_[found].fields.empty())
        return refuse(wanted.type, "a type that the schema defines, with fields");
      out_.types_[wanted.owner].fields[wanted.field].type = found;
    }
    return depth(0, 0);
  }

  Status depth(std::size_t type, std::size_t deep) {
    if (deep > kDeepest || ++visited_ > kMostColumns)
      return refuse(out_.types_[type].name, fmt::format("types up to {} deep", kDeepest));
    for (const Field& field : out_.types_[type].fields)
      if (field.kind == Kind::kStruct) NERITIC_TRY_STATUS(depth(field.type, deep + 1));
    return {};
  }

  struct Wanted {
    std::size_t owner, field;
    std::string type;
  };
  const McapSchema& schema_;
  RosMessage& out_;
  std::vector<Wanted> wanted_;
  std::size_t visited_ = 0;
};

// Goes through a message; without one it names the columns.
class RosMessage::Walk {
 public:
  Walk(const RosMessage& message, CdrReader* in) : message_(message), in_(in) {}

  bool type(std::size_t index, const std::string& name) {
    for (const Field& field : message_.types_[index].fields) {
      const std::string full = name.empty() ? field.name : name + "_" + field.name;
      if (!one_field(field, full)) return false;
    }
    return true;
  }

  std::vector<Column> columns;
  std::vector<RosValue> values;
  // Bytes of the uint8 list in that column are kept as they are.
  std::optional<std::size_t> wanted_bytes;
  std::vector<std::byte> bytes;

 private:
  bool one_field(const Field& field, const std::string& name) {
    if (!field.many) return item(field, name);
    if (field.count > 0 && field.count <= kWidestArray) {
      for (std::size_t i = 0; i < field.count; ++i)
        if (!item(field, fmt::format("{}_{}", name, i))) return false;
      return true;
    }
    return list(field, name);
  }

  bool add(const std::string& name, RosValue value, bool list, bool text) {
    if (in_ == nullptr) columns.push_back({name, list, text});
    values.push_back(std::move(value));
    return values.size() <= kMostColumns;
  }

  bool item(const Field& field, const std::string& name) {
    if (field.kind == Kind::kStruct) return type(field.type, name);
    if (in_ == nullptr) return add(name, 0.0, false, field.kind == Kind::kText);
    RosValue value = scalar(field.kind);
    return in_->whole() && add(name, std::move(value), false, field.kind == Kind::kText);
  }

  RosValue scalar(Kind kind) {
    switch (kind) {
      case Kind::kBool:
      case Kind::kUint8:
        return std::uint64_t{in_->number<std::uint8_t>()};
      case Kind::kInt8:
        return std::int64_t{in_->number<std::int8_t>()};
      case Kind::kInt16:
        return std::int64_t{in_->number<std::int16_t>()};
      case Kind::kUint16:
        return std::uint64_t{in_->number<std::uint16_t>()};
      case Kind::kInt32:
        return std::int64_t{in_->number<std::int32_t>()};
      case Kind::kUint32:
        return std::uint64_t{in_->number<std::uint32_t>()};
      case Kind::kInt64:
        return in_->number<std::int64_t>();
      case Kind::kUint64:
        return in_->number<std::uint64_t>();
      case Kind::kFloat32:
        return static_cast<double>(in_->number<float>());
      case Kind::kText:
        return in_->text();
      default:
        return in_->number<double>();
    }
  }

  bool list(const Field& field, const std::string& name) {
    std::vector<double> numbers;
    if (in_ == nullptr) return add(name, std::move(numbers), true, false);
    const std::size_t count = field.count > 0 ? field.count : in_->number<std::uint32_t>();
    if (!in_->whole() || count > in_->left() || count > kMostNumbers) return false;
    if (field.kind == Kind::kUint8) {
      const auto raw = in_->bytes(count);
      if (wanted_bytes == values.size())
        bytes.assign(raw.begin(), raw.end());
      else
        for (const std::byte b : raw) numbers.push_back(std::to_integer<int>(b));
    } else {
      for (std::size_t i = 0; i < count; ++i)
        if (!list_item(field, numbers)) return false;
    }
    return in_->whole() && add(name, std::move(numbers), true, false);
  }

  // Its numbers in a row; texts are left out.
  bool list_item(const Field& field, std::vector<double>& numbers) {
    if (field.kind != Kind::kStruct) {
      const RosValue value = scalar(field.kind);
      if (!in_->whole() || numbers.size() >= kMostNumbers) return false;
      if (field.kind != Kind::kText) numbers.push_back(number_of(value));
      return true;
    }
    for (const Field& inner : message_.types_[field.type].fields) {
      const std::size_t count = !inner.many       ? 1
                                : inner.count > 0 ? inner.count
                                                  : in_->number<std::uint32_t>();
      if (!in_->whole() || count > in_->left()) return false;
      for (std::size_t i = 0; i < count; ++i)
        if (!list_item(inner, numbers)) return false;
    }
    return true;
  }

  const RosMessage& message_;
  CdrReader* in_;
};

Result<RosMessage> RosMessage::parse(const McapSchema& schema) {
  if (schema.encoding != "ros2msg")
    return refusal(printable(schema.name),
                   fmt::format("a schema of '{}'", printable(schema.encoding)), "ros2msg");
  RosMessage out;
  NERITIC_TRY_STATUS(Parser(schema, out).run());
  Walk walk(out, nullptr);
  if (!walk.type(0, {}))
    return refusal(printable(schema.name), "more columns", fmt::format("up to {}", kMostColumns));
  out.columns_ = std::move(walk.columns);
  return out;
}

std::optional<std::size_t> RosMessage::column(std::string_view name) const {
  for (std::size_t i = 0; i < columns_.size(); ++i)
    if (columns_[i].name == name) return i;
  return std::nullopt;
}

std::optional<std::vector<RosValue>> RosMessage::read(std::span<const std::byte> bytes) const {
  CdrReader in(bytes);
  Walk walk(*this, &in);
  if (!in.whole() || !walk.type(0, {}) || !in.whole()) return std::nullopt;
  return std::move(walk.values);
}

std::optional<std::vector<std::byte>> RosMessage::read_bytes(std::span<const std::byte> bytes,
                                                             std::size_t column) const {
  CdrReader in(bytes);
  Walk walk(*this, &in);
  walk.wanted_bytes = column;
  if (!in.whole() || !walk.type(0, {}) || !in.whole()) return std::nullopt;
  return std::move(walk.bytes);
}

double number_of(const RosValue& value) {
  if (const auto* number = std::get_if<double>(&value)) return *number;
  if (const auto* number = std::get_if<std::int64_t>(&value)) return static_cast<double>(*number);
  if (const auto* number = std::get_if<std::uint64_t>(&value)) return static_cast<double>(*number);
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace neritic::recording
