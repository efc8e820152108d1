// Checked reading of files of cases (JSON) and of vehicles (TOML): every getter says what it
// accepts and records the first thing that is wrong, as "file: case 'id': field: found ...;
// accepted: ...", of TOML with the line, "file:line: field: ...". Later getters return their
// fallbacks, so that a reader reads on and asks once whether it failed. One thread.
#pragma once

#include <initializer_list>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/math.hpp"
#include "engine/core/result.hpp"

namespace neritic {

class CaseField;

// The document of one file, and what was wrong first.
class CaseFile {
 public:
  // name stands in messages. Errors: no JSON object.
  static Result<CaseFile> parse(std::string_view text, std::string name);
  // places: where fields are, as "file:line" by path; of a field that is not there, where what
  // holds it is.
  CaseFile(nlohmann::json&& object, std::string name,
           std::map<std::string, std::string> places = {});
  CaseFile(CaseFile&&) noexcept;
  CaseFile& operator=(CaseFile&&) noexcept;
  ~CaseFile();

  CaseField root();
  // From here on faults are said to be in this case; empty: in the file.
  void enter_case(std::string id) { case_ = std::move(id); }
  const std::string& name() const { return name_; }
  bool failed() const { return error_.has_value(); }
  // Precondition: failed().
  const Error& error() const { return *error_; }
  void fail(const std::string& field, const std::string& message);

 private:
  std::string place_of(std::string field) const;

  std::string name_, case_;
  std::map<std::string, std::string> places_;
  std::unique_ptr<nlohmann::json> json_;
  std::optional<Error> error_;
};

// A place in the document, perhaps absent (null counts as absent). Borrows the file.
class CaseField {
 public:
  CaseField(CaseFile& file, const nlohmann::json* value, std::string path)
      : file_(&file), value_(value), path_(std::move(path)) {}

  bool present() const;
  bool is_number() const;
  bool is_text() const;
  bool is_array() const;
  bool is_object() const;
  const std::string& path() const { return path_; }

  // A member of an object, absent where there is none. Fails where this is no object.
  CaseField operator[](std::string_view key) const;
  // The same; fails where it is absent too.
  CaseField required(std::string_view key) const;
  // Members of an object, sorted; none where this is none.
  std::vector<std::string> keys() const;
  // Elements of an array, 0 where absent. Fails where this is no array.
  std::size_t size() const;
  CaseField at(std::size_t i) const;

  std::string text(std::string_view fallback = {}) const;
  bool boolean(bool fallback) const;
  // In [least, most], finite.
  double number(double fallback, double least = -1e300, double most = 1e300) const;
  // Exactly count finite numbers; empty where absent or refused.
  std::vector<double> numbers(std::size_t count) const;
  // A list of finite numbers of any length.
  std::vector<double> numbers() const;
  // Rows of columns numbers each; any number of rows where rows is 0.
  std::vector<std::vector<double>> rows(std::size_t rows, std::size_t columns) const;

  // Exactly count numbers; fails where they are absent too.
  std::vector<double> required_numbers(std::size_t count) const;
  Vec3 vec3(const Vec3& fallback) const;
  // n rows of n numbers, or its diagonal alone; empty where absent or refused.
  std::vector<std::vector<double>> square(std::size_t n) const;
  // Fails if a member has none of these names; the message has the nearest.
  void allow(std::span<const std::string_view> names) const;
  // The same, but a text under another name is a note for people, unless its name is a slip of one
  // of these (is_slip).
  void allow_with_texts(std::initializer_list<std::string_view> names) const;

  // Records "field: found F; accepted: A".
  void refuse(std::string_view accepted) const;
  std::vector<double> finite_numbers(std::string_view accepted) const;
  void refuse_entry(const nlohmann::json& entry, std::size_t i, std::string_view accepted) const;
  void fail(const std::string& message) const { file_->fail(path_, message); }

 private:
  std::string found() const;
  CaseFile* file_;
  const nlohmann::json* value_;
  std::string path_;
};

}  // namespace neritic
