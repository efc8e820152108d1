// Checked reading of a glTF file's JSON: every getter accepts what the specification accepts and
// records the first thing that is wrong, with its path, in the file's Report. Later getters then
// return their fallbacks, so a stage reads on and its caller asks once whether it failed. One
// thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/refusal.hpp"

namespace neritic::scene::gltf {

using Json = nlohmann::json;

// The messages about one file: its first error, and notes for the user (each once).
class Report {
 public:
  explicit Report(std::string file) : file_(std::move(file)) {}
  const std::string& file() const { return file_; }
  bool failed() const { return failure_.has_value(); }
  // Precondition: failed().
  Error error() const;
  // Only the first failure counts: what follows it is mostly its echo.
  void fail(std::string_view path, std::string_view message);
  // After kMaxNotes the rest is summed up in one line.
  void note(std::string line);
  // Turns a failure into a note, for data that a model does not need.
  void note_failure();
  bool takes_notes() const { return notes_.size() < kMaxNotes; }
  std::vector<std::string> take_notes() { return std::move(notes_); }

 private:
  static constexpr std::size_t kMaxNotes = 32;
  std::string file_;
  std::optional<std::string> failure_;  // with its path, without the file
  std::vector<std::string> notes_;
  std::set<std::string> said_;
};

// The same text on one line: control characters become '?', long text is cut.
std::string one_line(std::string_view text, std::size_t max_length = 300);

// A place in the JSON, perhaps absent. Borrows the document and the report.
class Field {
 public:
  Field(const Json* root, const Json* value, Report* report)
      : root_(root), value_(value), report_(report) {}

  bool present() const { return value_ != nullptr; }
  // The place itself, to tell fields apart; null where absent.
  const Json* place() const { return value_; }
  // The same document, nowhere in it.
  Field absent() const { return {root_, nullptr, report_}; }
  // A member of an object; absent where there is none. Fails where this is no object.
  Field operator[](std::string_view key) const;
  // Elements of an array, 0 where absent. Fails where this is no array.
  std::size_t size() const;
  Field at(std::size_t i) const;
  // Members of an object, sorted.
  std::vector<std::string> keys() const;
  // The named extension's object, absent where there is none.
  Field extension(std::string_view name) const { return (*this)["extensions"][name]; }

  std::string text(std::string_view fallback = {}) const;
  bool boolean(bool fallback) const;
  double number(double fallback) const;
  // Clamped to float's finite range.
  float number_f(float fallback) const;
  // A whole number from 0 to max.
  std::uint64_t whole(std::uint64_t fallback, std::uint64_t max = UINT64_MAX) const;
  // An index below count; -1 where absent. what names the things counted ("meshes").
  int index(std::size_t count, std::string_view what) const;
  // Exactly N numbers.
  template <std::size_t N>
  std::array<double, N> numbers(const std::array<double, N>& fallback) const {
    std::array<double, N> out = fallback;
    return read_numbers(out.data(), N) ? out : fallback;
  }

  // "meshes[0].primitives[1]"; found by searching the document, since only failures need it.
  std::string path() const;
  // Both search the path, so only for what will be said.
  void fail(std::string_view message) const {
    if (!report_->failed()) report_->fail(path(), message);
  }
  // Fails with "found X; accepted: Y".
  void refuse(std::string_view found, std::string_view accepted) const {
    fail(found_accepted(found, accepted));
  }
  template <class... Args>
  void note_with(fmt::format_string<Args...> format, Args&&... args) const {
    if (report_->takes_notes())
      report_->note(path() + ": " + fmt::format(format, std::forward<Args>(args)...));
  }
  Report& report() const { return *report_; }

 private:
  bool read_numbers(double* out, std::size_t count) const;
  // The value in short, as found in the file, for messages.
  std::string found() const;

  const Json* root_;
  const Json* value_;
  Report* report_;
};

// Parses text into out. Nesting deeper than 128 and anything that is no JSON object is refused.
void parse_json(std::string_view text, Json& out, Report& report);

}  // namespace neritic::scene::gltf
