// `neritic plan`: a dive planned, or a log of depths replayed; as text or JSON, and as a picture.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <vector>

#include "diver/gas_label.hpp"
#include "engine/core/check.hpp"
#include "engine/core/files.hpp"
#include "engine/core/refusal.hpp"
#include "tools/common/outputs.hpp"
#include "tools/common/picture.hpp"
#include "tools/neritic/plan_picture.hpp"
#include "tools/neritic/plan_report.hpp"
#include "tools/neritic/plan_request.hpp"
#include "tools/neritic/plan_trace.hpp"

namespace neritic::tools {
namespace {

std::string gf_text(double low, double high) {
  return fmt::format("GF {:g}/{:g}", 100.0 * low, 100.0 * high);
}

// The water and the air over it, and earlier dives.
std::string conditions(const PlanFlags& flags, const diver::DecoEnvironment& where) {
  std::string out = fmt::format("surface {:.4g} bar", where.surface_bar);
  if (flags.altitude_m) out += fmt::format(", {:g} m above the sea", *flags.altitude_m);
  out += fmt::format("; {}water, {:.4g} bar a metre", flags.water.empty() ? "" : flags.water + " ",
                     where.bar_per_m);
  for (const std::string& dive : flags.after)
    out += "; after a dive of " + dive + " (m, min, min at the surface)";
  return out;
}

// --plot's picture, and the one in --out's folder, which is drawn once for both; whether what was
// asked for is drawn.
Result<bool> write_pictures(const PlanFlags& flags, const char* name, const PlanPicture& picture,
                            const DiveTrace& trace) {
  const nlohmann::json data = plan_picture_data(picture, trace);
  if (flags.out.empty()) return write_picture(flags.plot, data);
  const std::filesystem::path in_folder = flags.out / name;
  NERITIC_TRY(const bool drawn, write_picture(in_folder, data));
  if (flags.plot.empty()) return drawn;
  const auto copy = [](const std::filesystem::path& from,
                       const std::filesystem::path& to) -> Status {
    NERITIC_TRY(const std::vector<std::byte> bytes, read_file(from));
    return write_file(to, bytes);
  };
  NERITIC_TRY_STATUS(copy(picture_data_path(in_folder), picture_data_path(flags.plot)));
  if (drawn) NERITIC_TRY_STATUS(copy(in_folder, flags.plot));
  return drawn;
}

// Where the results are. Nothing where JSON was printed, which stands alone.
std::string written(const PlanFlags& flags, const char* stem, const char* table, bool drawn) {
  if (flags.json || (flags.out.empty() && flags.plot.empty())) return {};
  if (flags.out.empty()) return (drawn ? flags.plot : picture_data_path(flags.plot)).string();
  return fmt::format("{}: {}, {}.plot.json{}", flags.out.string(), table, stem,
                     drawn ? fmt::format(", {}.png", stem) : "");
}

Result<std::string> plan_a_dive(const PlanFlags& flags) {
  if (!flags.vehicle.empty()) return refusal("--vehicle", "without --log", "with --log");
  if (flags.depths_up) return refusal("--depths-up", "without --log", "with --log");
  NERITIC_TRY(const diver::DivePlanRequest request, plan_request(flags));
  NERITIC_TRY(const PlanGasFlags gas, plan_gas(flags, request));
  NERITIC_TRY(const PlanReport report,
              make_plan_report(flags.convention, request, gas.breathing, gas.tanks));
  if (!flags.out.empty()) {
    NERITIC_TRY_STATUS(make_folder(flags.out));
    NERITIC_TRY_STATUS(write_text(flags.out / "plan.json", plan_json(report)));
  }
  std::string levels;
  for (const diver::PlanLevel& level : request.levels)
    levels += fmt::format("{}{:g} m, {:g} min", levels.empty() ? "" : "; ", level.depth_m,
                          level.leave_min);
  bool drawn = true;
  if (!flags.plot.empty() || !flags.out.empty()) {
    PlanPicture picture{
        fmt::format("{} on {}", levels, diver::name_of(request.gases[0].mix)),
        {fmt::format("{}, {}; run time {:.1f} min, stops {:.1f} min, CNS {:.0f} %, OTU {:.0f}; for "
                     "planning with judgement, no substitute for training",
                     gf_text(request.gf_low, request.gf_high), flags.convention,
                     report.plan.run_min(), report.plan.stop_min(), report.oxygen().cns_percent,
                     report.oxygen().otu),
         conditions(flags, request.conventions.environment)},
        {},
        request.conventions,
        request.gf_high,
        request.gases,
        report.plan.stops,
        gas_curves(report)};
    for (const diver::PlanWarning& warning : report.warnings)
      picture.warnings.push_back(warning.text);
    NERITIC_TRY(drawn,
                write_pictures(flags, "plan.png", picture, trace_plan(request, report.plan)));
  }
  fmt::print("{}", flags.json ? plan_json(report) : plan_text(report));
  std::fflush(stdout);
  return written(flags, "plan", "plan.json", drawn);
}

std::string log_text(const PlanFlags& flags, const diver::DepthLog& log,
                     diver::BuehlmannTable table, const DiveTrace& trace) {
  const diver::DiveComputerState& end = trace.end;
  const diver::DiveComputerView& view = trace.rows.back().view;
  std::string out = fmt::format("{}: {} samples, {} refused, {:.1f} min, deepest {:.1f} m; {}\n",
                                flags.log, log.samples.size(), log.failed,
                                trace.rows.back().run_min, end.deepest_m, table_words(table));
  out += fmt::format("deepest ceiling {:.1f} m, {:.1f} min above it; {:.1f} min of ascent alarm\n",
                     trace.most_ceiling_m, trace.above_ceiling_min, trace.fast_min);
  out += fmt::format(
      "at the end: {:.1f} m, ceiling {:.1f} m, {:.0f} % of the M-value at the surface, "
      "CNS {:.1f} %, OTU {:.0f}",
      end.last.depth_m, view.ceiling_m, 100.0 * std::max(view.surface_gradient, 0.0),
      end.oxygen.cns_percent, end.oxygen.otu);
  if (view.stop_m > 0.0)
    out += fmt::format("; next stop {:g} m {:g} min, {}", view.stop_m, view.stop_min,
                       std::isfinite(view.to_surface_min)
                           ? fmt::format("{:.0f} min to the surface", view.to_surface_min)
                           : "and the ceiling never clears");
  if (view.ceiling_violated) out += "; THE CEILING IS VIOLATED";
  out += "\n";
  for (const std::string& note : log.notes) out += "NOTE: " + note + "\n";
  return out;
}

std::vector<std::string> log_warnings(const diver::DepthLog& log, const DiveTrace& trace) {
  std::vector<std::string> out;
  if (trace.above_ceiling_min > 0.0)
    out.push_back(fmt::format("{:.1f} min above the ceiling", trace.above_ceiling_min));
  if (trace.fast_min > 0.0)
    out.push_back(fmt::format("{:.1f} min of ascent alarm", trace.fast_min));
  out.insert(out.end(), log.notes.begin(), log.notes.end());
  return out;
}

Result<std::string> replay_a_log(const PlanFlags& flags) {
  if (flags.depth_m || flags.time_min || !flags.levels.empty())
    return refusal("--log", "with --depth, --time or --level",
                   "without them, since a log has its own depths");
  NERITIC_TRY(const std::string text, read_text(flags.log));
  NERITIC_TRY(const diver::DepthLog log,
              diver::read_depth_log(text, flags.log, flags.vehicle, flags.depths_up));
  NERITIC_TRY(diver::DiveComputerSettings settings, log_settings(flags, log));
  NERITIC_TRY(const diver::DiveComputer computer, diver::DiveComputer::create(std::move(settings)));
  NERITIC_TRY(const diver::DiveComputerState start, log_start(flags, computer));
  const DiveTrace trace = trace_log(computer, start, log);
  NERITIC_CHECK(trace.end.refused == 0, "{} samples refused that the log's reader accepted",
                trace.end.refused);
  const diver::DiveComputerSettings& s = computer.settings();
  if (!flags.out.empty()) {
    NERITIC_TRY_STATUS(make_folder(flags.out));
    NERITIC_TRY_STATUS(write_text(flags.out / "log.csv", trace_csv(trace, s.gases)));
  }
  const PlanPicture picture{"Replayed: " + std::filesystem::path(flags.log).filename().string(),
                            {fmt::format("{}, {}; {} samples, {} refused, deepest ceiling {:.1f} m",
                                         gf_text(s.gf_low, s.gf_high), flags.convention,
                                         log.samples.size(), log.failed, trace.most_ceiling_m),
                             conditions(flags, s.conventions.environment)},
                            log_warnings(log, trace),
                            s.conventions,
                            s.gf_high,
                            s.gases,
                            {},
                            {}};
  bool drawn = true;
  if (!flags.plot.empty() || !flags.out.empty()) {
    NERITIC_TRY(drawn, write_pictures(flags, "log.png", picture, trace));
  }
  fmt::print("{}", flags.json ? log_json(flags.log, log, trace)
                              : log_text(flags, log, s.conventions.table, trace));
  std::fflush(stdout);
  return written(flags, "log", "log.csv", drawn);
}

}  // namespace

Result<std::string> run_plan(const PlanFlags& flags) {
  NERITIC_TRY_STATUS(check_output_folder("--out", flags.out));
  NERITIC_TRY_STATUS(check_output_file("--plot", flags.plot));
  return flags.log.empty() ? plan_a_dive(flags) : replay_a_log(flags);
}

}  // namespace neritic::tools
