// `neritic check rov|control|deco FILE`: every case of a file of trajectories, of control or of
// decompression, run and compared; a line a case.
#include <nlohmann/json.hpp>

#include "diver/deco_check.hpp"
#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "engine/core/refusal.hpp"
#include "rov/control_check.hpp"
#include "rov/trajectory_check.hpp"
#include "tools/neritic/commands.hpp"

namespace neritic::tools {
namespace {

Result<std::vector<CaseResult>> check_file(const CheckFlags& flags) {
  if (flags.what != "rov" && flags.what != "control" && flags.what != "deco")
    return refusal("check", fmt::format("'{}'", flags.what), "rov, control or deco");
  if (!(flags.hz >= 1.0 && flags.hz <= 1e5))
    return refusal("check: --hz", fmt::format("{}", flags.hz), "1 to 100000");
  NERITIC_TRY(const rov::Integrator integrator, rov::integrator_of(flags.integrator));
  NERITIC_TRY(const std::string text, read_text(flags.file));
  if (flags.what == "deco") {
    NERITIC_TRY(const auto cases, diver::read_deco_cases(text, flags.file));
    return diver::check_deco(cases);
  }
  std::vector<CaseResult> results;
  if (flags.what == "rov") {
    NERITIC_TRY(
        const auto cases,
        rov::read_trajectories(text, flags.file, std::filesystem::path(flags.file).parent_path()));
    for (const rov::TrajectoryCase& one : cases)
      results.push_back(rov::check_trajectory(one, {integrator, flags.hz}));
    return results;
  }
  NERITIC_TRY(const auto cases, rov::read_control_cases(text, flags.file));
  return rov::check_control(cases, {integrator, flags.hz});
}

// One line, whatever the file has as a name.
std::string name_of_case(const CaseResult& one) {
  std::string name = one.id;
  for (char& c : name)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  return name;
}

std::string line_of(const CaseResult& one, std::size_t id_width) {
  const CheckedError& worst = one.worst();
  const std::string unit = worst.unit.empty() ? "" : " " + worst.unit;
  const std::string when = worst.time_s > 0.0 ? fmt::format(", at {:g} s", worst.time_s) : "";
  const std::string note = one.note.empty() ? "" : "; " + one.note;
  return fmt::format("{:<{}}  {:<6}  error {:.2e}{} of {:.2e}{} allowed: {}{}{}\n",
                     name_of_case(one), id_width, one.ok() ? "ok" : "not ok", worst.error, unit,
                     worst.tolerance, unit, worst.what, when, note);
}

std::string text_of(const std::vector<CaseResult>& results) {
  std::size_t width = 0;
  for (const CaseResult& one : results) width = std::max(width, one.id.size());
  std::string text;
  for (const CaseResult& one : results) text += line_of(one, width);
  return text;
}

nlohmann::json error_json(const CheckedError& error) {
  return {{"what", error.what},           {"unit", error.unit},  {"error", error.error},
          {"tolerance", error.tolerance}, {"t_s", error.time_s}, {"ok", error.holds()}};
}

std::string json_of(const CheckFlags& flags, const std::vector<CaseResult>& results,
                    std::size_t failed) {
  nlohmann::json json{{"check", flags.what},
                      {"file", flags.file},
                      {"ok", failed == 0},
                      {"cases", nlohmann::json::array()}};
  if (flags.what != "deco") {
    json["integrator"] = flags.integrator;
    json["hz"] = flags.hz;
  }
  json["failed"] = failed;
  for (const CaseResult& one : results) {
    nlohmann::json entry{{"id", one.id}, {"ok", one.ok()}, {"worst", error_json(one.worst())}};
    if (!one.note.empty()) entry["note"] = one.note;
    for (const CheckedError& error : one.errors) entry["errors"].push_back(error_json(error));
    json["cases"].push_back(std::move(entry));
  }
  return json_text(json) + "\n";
}

}  // namespace

Status run_check(const CheckFlags& flags) {
  NERITIC_TRY(const std::vector<CaseResult> results, check_file(flags));
  const auto failed = static_cast<std::size_t>(
      std::ranges::count_if(results, [](const CaseResult& one) { return !one.ok(); }));
  fmt::print("{}", flags.json ? json_of(flags, results, failed) : text_of(results));
  std::fflush(stdout);
  if (failed == 0) return {};
  return failure(ErrorCode::kUnsupported, "{}: {} of {} cases do not hold", flags.file, failed,
                 results.size());
}

}  // namespace neritic::tools
