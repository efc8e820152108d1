// See case_file.hpp.
#include "engine/core/case_file.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/core/json.hpp"
#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"

namespace neritic {

CaseFile::CaseFile(nlohmann::json&& object, std::string name,
                   std::map<std::string, std::string> places)
    : name_(std::move(name)),
      places_(std::move(places)),
      json_(std::make_unique<nlohmann::json>(std::move(object))) {}
CaseFile::CaseFile(CaseFile&&) noexcept = default;
CaseFile& CaseFile::operator=(CaseFile&&) noexcept = default;
CaseFile::~CaseFile() = default;

Result<CaseFile> CaseFile::parse(std::string_view text, std::string name) {
  Result<nlohmann::json> parsed = parse_json(text);
  if (!parsed.ok())
    return bad_input("{}: no JSON: {}", name, printable(parsed.error().message, 200));
  if (!parsed->is_object()) return refusal(name, "no JSON object", "one");
  return CaseFile(std::move(*parsed), std::move(name));
}

CaseField CaseFile::root() {
  return {*this, json_.get(), ""};
}

void CaseFile::fail(const std::string& field, const std::string& message) {
  if (error_) return;
  std::string text = place_of(field) + ": ";
  if (!case_.empty()) text += "case '" + printable(case_, 60) + "': ";
  if (!field.empty()) text += printable(field, 100) + ": ";
  error_ = bad_input("{}{}", text, printable(message, 300));
}

std::string CaseFile::place_of(std::string field) const {
  for (;;) {
    if (const auto at = places_.find(field); at != places_.end()) return at->second;
    const std::size_t end = field.find_last_of(".[");
    if (end == field.npos) return name_;
    field.resize(end);
  }
}

bool CaseField::present() const {
  return value_ && !value_->is_null();
}
bool CaseField::is_number() const {
  return present() && value_->is_number();
}
bool CaseField::is_text() const {
  return present() && value_->is_string();
}
bool CaseField::is_array() const {
  return present() && value_->is_array();
}
bool CaseField::is_object() const {
  return present() && value_->is_object();
}

CaseField CaseField::operator[](std::string_view key) const {
  const std::string path = path_.empty() ? std::string(key) : path_ + "." + std::string(key);
  if (!present()) return {*file_, nullptr, path};
  if (!value_->is_object()) {
    refuse("an object");
    return {*file_, nullptr, path};
  }
  const auto it = value_->find(std::string(key));
  return {*file_, it == value_->end() ? nullptr : &*it, path};
}

CaseField CaseField::required(std::string_view key) const {
  CaseField field = (*this)[key];
  if (!field.present() && !file_->failed()) field.fail("not found, but needed");
  return field;
}

std::vector<std::string> CaseField::keys() const {
  std::vector<std::string> out;
  if (!is_object()) return out;
  for (auto it = value_->begin(); it != value_->end(); ++it) out.push_back(it.key());
  return out;
}

std::size_t CaseField::size() const {
  if (!present()) return 0;
  if (value_->is_array()) return value_->size();
  refuse("a list");
  return 0;
}

CaseField CaseField::at(std::size_t i) const {
  const bool there = is_array() && i < value_->size();
  return {*file_, there ? &(*value_)[i] : nullptr, fmt::format("{}[{}]", path_, i)};
}

std::string CaseField::text(std::string_view fallback) const {
  if (is_text()) return value_->get<std::string>();
  if (present()) refuse("a text");
  return std::string(fallback);
}

bool CaseField::boolean(bool fallback) const {
  if (present() && value_->is_boolean()) return value_->get<bool>();
  if (present()) refuse("true or false");
  return fallback;
}

double CaseField::number(double fallback, double least, double most) const {
  if (!present()) return fallback;
  if (value_->is_number()) {
    const double number = value_->get<double>();
    if (number >= least && number <= most) return number;
  }
  if (least > -1e300 || most < 1e300)
    refuse(fmt::format("a number in [{}, {}]", least, most));
  else
    refuse("a number");
  return fallback;
}

std::vector<double> CaseField::numbers() const {
  return finite_numbers("a list of numbers");
}

std::vector<double> CaseField::finite_numbers(std::string_view accepted) const {
  std::vector<double> out;
  if (!present()) return out;
  if (!value_->is_array()) {
    refuse(accepted);
    return out;
  }
  for (const nlohmann::json& item : *value_) {
    if (!item.is_number() || !std::isfinite(item.get<double>())) {
      refuse_entry(item, out.size(), accepted);
      return {};
    }
    out.push_back(item.get<double>());
  }
  return out;
}

std::vector<double> CaseField::numbers(std::size_t count) const {
  if (!present()) return {};
  const std::string accepted = fmt::format("a list of {} numbers", count);
  if (value_->is_array() && value_->size() == count) return finite_numbers(accepted);
  refuse(accepted);
  return {};
}

std::vector<std::vector<double>> CaseField::rows(std::size_t rows, std::size_t columns) const {
  std::vector<std::vector<double>> out;
  if (!present()) return out;
  const bool good = value_->is_array() && (rows == 0 || value_->size() == rows);
  if (!good) {
    refuse(rows == 0 ? fmt::format("a list of rows of {} numbers", columns)
                     : fmt::format("{} rows of {} numbers", rows, columns));
    return out;
  }
  for (std::size_t i = 0; i < value_->size(); ++i) {
    out.push_back(at(i).required_numbers(columns));
    if (out.back().size() != columns) return {};
  }
  return out;
}

std::vector<double> CaseField::required_numbers(std::size_t count) const {
  if (!present()) fail("not found, but needed");
  return numbers(count);
}

Vec3 CaseField::vec3(const Vec3& fallback) const {
  const std::vector<double> v = numbers(3);
  return v.empty() ? fallback : Vec3(v[0], v[1], v[2]);
}

std::vector<std::vector<double>> CaseField::square(std::size_t n) const {
  if (!present()) return {};
  if (is_array() && size() == n && at(0).is_array()) return rows(n, n);
  if (!is_array() || size() != n) {
    refuse(fmt::format("{} rows of {} numbers, or {} of a diagonal", n, n, n));
    return {};
  }
  const std::vector<double> diagonal = numbers(n);
  std::vector<std::vector<double>> out(diagonal.size(), std::vector<double>(n, 0.0));
  for (std::size_t i = 0; i < diagonal.size(); ++i) out[i][i] = diagonal[i];
  return out;
}

void CaseField::allow(std::span<const std::string_view> names) const {
  for (const std::string& key : keys())
    if (std::ranges::find(names, key) == names.end())
      (*this)[key].fail(fmt::format("not known; the nearest is {}", nearest(key, names)));
}

void CaseField::allow_with_texts(std::initializer_list<std::string_view> names) const {
  const std::span<const std::string_view> known(names.begin(), names.size());
  for (const std::string& key : keys()) {
    if (std::ranges::find(known, key) != known.end()) continue;
    const CaseField member = (*this)[key];
    const std::string_view near = nearest(key, known);
    if (!member.is_text() || is_slip(key, near))
      member.fail(fmt::format("not known; the nearest is {}", near));
  }
}

void CaseField::refuse(std::string_view accepted) const {
  if (!file_->failed()) fail(found_accepted(found(), accepted));
}

void CaseField::refuse_entry(const nlohmann::json& entry, std::size_t i,
                             std::string_view accepted) const {
  if (file_->failed()) return;
  fail(found_accepted(fmt::format("{} as entry {}", printable(json_text(entry, -1), 40), i),
                      accepted));
}

std::string CaseField::found() const {
  if (!present()) return "nothing";
  if (value_->is_object()) return "an object";
  if (value_->is_array() && json_text(*value_, -1).size() > 60)
    return fmt::format("a list of {}", value_->size());
  return printable(json_text(*value_, -1), 60);
}

}  // namespace neritic
