// See gltf_json.hpp.
#include "engine/scene/gltf_json.hpp"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "engine/core/json.hpp"

namespace neritic::scene::gltf {
namespace {

bool find_path(const Json& from, const Json* wanted, std::string& path) {
  if (&from == wanted) return true;
  const std::size_t length = path.size();
  if (from.is_object()) {
    for (auto it = from.begin(); it != from.end(); ++it) {
      path += length == 0 ? it.key() : "." + it.key();
      if (find_path(*it, wanted, path)) return true;
      path.resize(length);
    }
  } else if (from.is_array()) {
    for (std::size_t i = 0; i < from.size(); ++i) {
      path += fmt::format("[{}]", i);
      if (find_path(from[i], wanted, path)) return true;
      path.resize(length);
    }
  }
  return false;
}

}  // namespace

std::string one_line(std::string_view text, std::size_t max_length) {
  std::string line(text.substr(0, max_length));
  for (char& c : line)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  if (text.size() > max_length) line += "...";
  return line;
}

Error Report::error() const {
  return bad_input("{}: {}", one_line(file_, 4096), *failure_);
}

void Report::fail(std::string_view path, std::string_view message) {
  if (failure_) return;
  failure_ = (path.empty() ? "" : one_line(path) + ": ") + one_line(message);
}

void Report::note_failure() {
  if (failure_) note(*std::exchange(failure_, std::nullopt));
}

void Report::note(std::string line) {
  if (!takes_notes()) return;
  line = one_line(line);
  if (!said_.insert(line).second) return;
  notes_.push_back(notes_.size() + 1 < kMaxNotes ? std::move(line) : "further notes are left out");
}

Field Field::operator[](std::string_view key) const {
  if (!value_) return *this;
  if (!value_->is_object()) {
    refuse(found(), "an object");
    return {root_, nullptr, report_};
  }
  const auto it = value_->find(std::string(key));
  return {root_, it == value_->end() ? nullptr : &*it, report_};
}

std::size_t Field::size() const {
  if (!value_) return 0;
  if (value_->is_array()) return value_->size();
  refuse(found(), "an array");
  return 0;
}

Field Field::at(std::size_t i) const {
  return {root_, value_ && value_->is_array() && i < value_->size() ? &(*value_)[i] : nullptr,
          report_};
}

std::vector<std::string> Field::keys() const {
  std::vector<std::string> out;
  if (!value_) return out;
  if (!value_->is_object()) {
    refuse(found(), "an object");
    return out;
  }
  for (auto it = value_->begin(); it != value_->end(); ++it) out.push_back(it.key());
  return out;
}

std::string Field::text(std::string_view fallback) const {
  if (!value_) return std::string(fallback);
  if (value_->is_string()) return value_->get<std::string>();
  refuse(found(), "a string");
  return std::string(fallback);
}

bool Field::boolean(bool fallback) const {
  if (!value_) return fallback;
  if (value_->is_boolean()) return value_->get<bool>();
  refuse(found(), "true or false");
  return fallback;
}

double Field::number(double fallback) const {
  if (!value_) return fallback;
  if (value_->is_number()) return value_->get<double>();
  refuse(found(), "a number");
  return fallback;
}

float Field::number_f(float fallback) const {
  constexpr double kMax = std::numeric_limits<float>::max();
  return static_cast<float>(std::clamp(number(fallback), -kMax, kMax));
}

std::uint64_t Field::whole(std::uint64_t fallback, std::uint64_t max) const {
  if (!value_) return fallback;
  std::uint64_t value = 0;
  bool whole = false;
  if (value_->is_number_unsigned()) {
    value = value_->get<std::uint64_t>();
    whole = true;
  } else if (value_->is_number_float()) {  // 3.0 is a whole number too
    const double number = value_->get<double>();
    whole = number >= 0.0 && number <= 9007199254740992.0 && number == std::floor(number);
    if (whole) value = static_cast<std::uint64_t>(number);
  }
  if (whole && value <= max) return value;
  if (max == UINT64_MAX)
    refuse(found(), "a whole number from 0");
  else
    refuse(found(), fmt::format("a whole number from 0 to {}", max));
  return fallback;
}

int Field::index(std::size_t count, std::string_view what) const {
  if (!value_) return -1;
  const std::uint64_t value = whole(UINT64_MAX);
  if (value < count) return static_cast<int>(value);
  if (!report_->failed())
    refuse(found(), fmt::format("an index below {}, the number of {}", count, what));
  return -1;
}

bool Field::read_numbers(double* out, std::size_t count) const {
  if (!value_) return false;
  const std::string accepted = fmt::format("a list of {} numbers", count);
  if (!value_->is_array() || value_->size() != count) {
    refuse(found(), accepted);
    return false;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const Json& entry = (*value_)[i];
    if (!entry.is_number()) {
      refuse(fmt::format("{} as entry {}", one_line(json_text(entry, -1), 40), i), accepted);
      return false;
    }
    out[i] = entry.get<double>();
  }
  return true;
}

std::string Field::path() const {
  std::string path;
  if (value_) find_path(*root_, value_, path);
  return path;
}

std::string Field::found() const {
  if (!value_) return "nothing";
  if (value_->is_object()) return "an object";
  if (value_->is_array()) {
    std::string text = json_text(*value_, -1);
    return text.size() <= 60 ? one_line(text, 60) : fmt::format("an array of {}", value_->size());
  }
  if (value_->is_string()) return "\"" + one_line(value_->get<std::string>(), 40) + "\"";
  return one_line(json_text(*value_, -1), 40);
}

void parse_json(std::string_view text, Json& out, Report& report) {
  Result<Json> parsed = neritic::parse_json(text);
  if (!parsed.ok()) return report.fail("", "no glTF JSON: " + parsed.error().message);
  out = std::move(*parsed);
  if (!out.is_object()) report.fail("", "no JSON object found where glTF has one");
}

}  // namespace neritic::scene::gltf
