#include "rov/sine_wrench.hpp"

#include <algorithm>
#include <optional>

namespace neritic::rov {
namespace {

constexpr std::string_view kAxes = "XYZKMN";
constexpr double kMostSine = 1e9;      // N, N m
constexpr double kMostSineRate = 1e6;  // rad/s

enum class Member { kAmplitude, kAxis, kRadS, kHertz, kPeriod, kPhase, kPhaseDeg, kNote, kUnknown };

Member member_of(std::string name) {
  for (char& c : name) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  const auto begins = [&](std::string_view with) { return name.starts_with(with); };
  if (begins("ph")) return name.find("deg") == name.npos ? Member::kPhase : Member::kPhaseDeg;
  if (begins("axis") || begins("dof") || begins("index")) return Member::kAxis;
  if (begins("amp") || begins("tau") || name == "a") return Member::kAmplitude;
  // Before frequencies: one may be given in rad/s.
  if (begins("omega") || begins("w_") || name == "w" || name.find("rad") != name.npos)
    return Member::kRadS;
  if (begins("f") || name.find("hz") != name.npos) return Member::kHertz;
  if (begins("period") || name == "t" || name == "t_s") return Member::kPeriod;
  if (begins("doc") || begins("note")) return Member::kNote;
  return Member::kUnknown;
}

// One number for all six, or six; times scale.
Vec6 six(const CaseField& field, double scale) {
  Vec6 out;
  if (field.is_number()) {
    out.v.fill(scale * field.number(0.0));
    return out;
  }
  const std::vector<double> values = field.required_numbers(6);
  for (std::size_t i = 0; i < values.size(); ++i) out[i] = scale * values[i];
  return out;
}

std::size_t read_axis(const CaseField& field) {
  if (field.is_text()) {
    const std::string name = field.text();
    const auto at = name.size() == 1 ? kAxes.find(name[0]) : kAxes.npos;
    if (at != kAxes.npos) return at;
  } else if (field.is_number()) {
    const double number = field.number(0.0);
    if (number == std::floor(number) && number >= 0.0 && number <= 5.0)
      return static_cast<std::size_t>(number);
  }
  field.refuse("0 to 5 or one of X, Y, Z, K, M, N is");
  return 0;
}

// Six angular frequencies, 2 pi over each of the periods.
Vec6 read_period(const CaseField& field) {
  Vec6 out = six(field, 1.0);
  for (double& x : out.v) {
    if (!(x > 0.0)) field.refuse("periods above 0 are");
    x = 2.0 * kPi / std::max(x, 1e-9);
  }
  return out;
}

SineWrench read_object(const CaseField& object) {
  SineWrench out;
  std::optional<CaseField> amplitude, axis;
  bool has_frequency = false;
  for (const std::string& key : object.keys()) {
    const CaseField field = object[key];
    const Member member = member_of(key);
    if (!field.present()) continue;
    if (member == Member::kAmplitude) amplitude = field;
    if (member == Member::kAxis) axis = field;
    if (member == Member::kRadS) out.rad_s = six(field, 1.0);
    if (member == Member::kHertz) out.rad_s = six(field, 2.0 * kPi);
    if (member == Member::kPeriod) out.rad_s = read_period(field);
    if (member == Member::kPhase) out.phase_rad = six(field, 1.0);
    if (member == Member::kPhaseDeg) out.phase_rad = six(field, kPi / 180.0);
    has_frequency = has_frequency || member == Member::kRadS || member == Member::kHertz ||
                    member == Member::kPeriod;
    if (member == Member::kUnknown)
      field.fail("not known; amplitude, axis, omega, freq_hz, period_s, phase are accepted");
  }
  if (!amplitude)
    object.fail("no amplitude found; six numbers, or one with axis, are accepted");
  else if (axis)
    out.amplitude[read_axis(*axis)] = amplitude->number(0.0);
  else if (amplitude->is_number())
    amplitude->refuse("six numbers, or one with axis, are");
  else
    out.amplitude = six(*amplitude, 1.0);
  if (!has_frequency)
    object.fail("no frequency found; omega (rad/s), freq_hz or period_s is accepted");
  return out;
}

// [amplitude, omega, phase] of the axis, or with the axis as the row's own first.
SineWrench read_row(const CaseField& row, std::optional<std::size_t> axis) {
  SineWrench out;
  const std::size_t first = axis ? 0 : 1, size = row.size();
  if (size < first + 2 || size > first + 3) {
    row.refuse(axis ? "[amplitude, omega, phase] is" : "[axis, amplitude, omega, phase] is");
    return out;
  }
  const std::size_t i = axis ? *axis : read_axis(row.at(0));
  out.amplitude[i] = row.at(first).number(0.0);
  out.rad_s[i] = row.at(first + 1).number(0.0);
  out.phase_rad[i] = row.at(first + 2).number(0.0);
  return out;
}

// [amplitude, omega, phase]: six numbers first, then six each or one for all.
SineWrench read_columns(const CaseField& field) {
  SineWrench out;
  out.amplitude = six(field.at(0), 1.0);
  out.rad_s = six(field.at(1), 1.0);
  if (field.size() > 2) out.phase_rad = six(field.at(2), 1.0);
  return out;
}

std::vector<SineWrench> read_list(const CaseField& field) {
  std::vector<SineWrench> out;
  const std::size_t count = field.size();
  if ((count == 2 || count == 3) && field.at(0).is_array() && field.at(0).size() == 6)
    return {read_columns(field)};
  bool rows_of_axes = count == 6;
  for (std::size_t i = 0; i < count; ++i)
    rows_of_axes = rows_of_axes && field.at(i).is_array() && field.at(i).size() <= 3;
  for (std::size_t i = 0; i < count; ++i) {
    const CaseField item = field.at(i);
    if (item.is_object())
      out.push_back(read_object(item));
    else
      out.push_back(read_row(item, rows_of_axes ? std::optional(i) : std::nullopt));
  }
  return out;
}

}  // namespace

std::vector<SineWrench> read_sines(const CaseField& field) {
  if (!field.present()) return {};
  if (!field.is_object() && !field.is_array()) field.refuse("an object, or a list of them, is");
  const std::vector<SineWrench> out =
      field.is_object() ? std::vector{read_object(field)} : read_list(field);
  for (const SineWrench& sine : out)
    for (std::size_t i = 0; i < 6; ++i)
      if (!(std::abs(sine.amplitude[i]) <= kMostSine && std::abs(sine.rad_s[i]) <= kMostSineRate))
        field.refuse("amplitudes up to 1e9 and frequencies up to 1e6 rad/s are");
  return out;
}

}  // namespace neritic::rov
