// `neritic physio ecg|breath|gaze FILE`: a recording of a diver, analysed; table, JSON and picture.
#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "diver/physio_csv.hpp"
#include "diver/physio_wav.hpp"
#include "diver/physio_wfdb.hpp"
#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"
#include "tools/common/outputs.hpp"
#include "tools/common/picture.hpp"
#include "tools/neritic/physio_report.hpp"

namespace neritic::tools {
namespace {

// A whole number, or 0 where the channel is given by name.
Result<std::uint32_t> channel_number(const PhysioFlags& flags) {
  std::uint32_t number = 0;
  for (const char c : flags.channel) {
    if (c < '0' || c > '9' || number > 1000)
      return refusal("--channel", fmt::format("'{}'", flags.channel), "a number from 0");
    number = 10 * number + static_cast<std::uint32_t>(c - '0');
  }
  return number;
}

Result<diver::Recording> load_record(const PhysioFlags& flags) {
  std::filesystem::path header_path = flags.file;
  header_path.replace_extension(".hea");
  NERITIC_TRY(const std::string text, read_text(header_path));
  NERITIC_TRY(const diver::WfdbHeader header, diver::parse_wfdb_header(text, header_path.string()));
  const auto named = std::ranges::find_if(header.signals, [&](const diver::WfdbSignal& signal) {
    return !signal.name.empty() && signal.name == flags.channel;
  });
  auto channel = static_cast<std::uint32_t>(named - header.signals.begin());
  if (named == header.signals.end()) {
    const auto number = channel_number(flags);
    if (!number.ok()) {
      std::vector<std::string_view> names;
      for (const diver::WfdbSignal& signal : header.signals) names.push_back(signal.name);
      return refusal("--channel", fmt::format("'{}'", flags.channel),
                     fmt::format("{} or a number from 0", join(names)));
    }
    channel = *number;
  }
  if (channel >= header.signals.size())
    return refusal(header_path.string(), fmt::format("channel {}", channel),
                   fmt::format("0 to {}", header.signals.size() - 1));
  const auto data_path = header_path.parent_path() / header.signals[channel].file;
  NERITIC_TRY(const auto bytes, read_file(data_path));
  return diver::parse_wfdb_signal(header, channel, bytes, data_path.string());
}

// played: the table is on standard output already, but with --json.
template <class Report>
Result<std::string> show(const PhysioFlags& flags, const Report& report, bool played = false) {
  const std::string json = json_text(report_json(flags, report)) + "\n";
  const ReportText text = report_text(flags, report);
  std::string where;
  if (!flags.out.empty()) {
    NERITIC_TRY_STATUS(make_folder(flags.out));
    std::error_code no_such;
    if (std::filesystem::equivalent(flags.out / (flags.what + ".csv"), flags.file, no_such))
      return refusal("--out",
                     fmt::format("'{}', the recording's folder, where the table would replace it",
                                 flags.out.string()),
                     "another folder");
    NERITIC_TRY_STATUS(write_text(flags.out / (flags.what + ".csv"), text.table));
    NERITIC_TRY_STATUS(write_text(flags.out / (flags.what + ".json"), json));
    where = flags.out.string() + fmt::format(": {0}.csv, {0}.json", flags.what);
  }
  if (!flags.plot.empty()) {
    const auto drawn = write_picture(flags.plot, report_picture(flags, report));
    if (!drawn.ok()) return drawn.error();
  }
  if (flags.out.empty() || flags.json || flags.table) {
    if (flags.json)
      fmt::print("{}", json);
    else if (!played)
      fmt::print("{}{}", text.summary,
                 flags.table
                     ? text.table
                     : fmt::format("# {} rows: --table prints them, --out FOLDER writes them\n",
                                   std::ranges::count(text.table, '\n') - 1));
    std::fflush(stdout);
    return std::string();
  }
  if (!played) fmt::print("{}", text.summary);
  return where;
}

}  // namespace

Result<diver::Recording> load_recording(const PhysioFlags& flags) {
  const std::filesystem::path path = flags.file;
  const std::string kind = lower_case(path.extension().string());
  std::error_code none;
  if (std::filesystem::is_directory(path, none))
    return refusal(flags.file, "a folder", "a file of .csv, .wav, .hea or .dat");
  if (kind == ".csv") {
    NERITIC_TRY(const std::string text, read_text(path));
    return diver::parse_csv(text, flags.file, {flags.channel, flags.rate_hz});
  }
  if (kind == ".wav") {
    NERITIC_TRY(std::uint32_t channel, channel_number(flags));
    NERITIC_TRY(const auto bytes, read_file(path));
    return diver::parse_wav(bytes, flags.file, channel);
  }
  if (kind.empty() || kind == ".hea" || kind == ".dat") return load_record(flags);
  return refusal(flags.file, fmt::format("'{}'", kind), ".csv, .wav, .hea or .dat");
}

Result<std::string> run_physio(const PhysioFlags& flags) {
  NERITIC_TRY_STATUS(check_output_folder("--out", flags.out));
  NERITIC_TRY_STATUS(check_output_file("--plot", flags.plot));
  if (flags.table && flags.json) return refusal("--table, --json", "both", "one of them");
  if (flags.what == "ecg") {
    NERITIC_TRY(const EcgReport report, analyse_ecg(flags));
    return show(flags, report);
  }
  if (flags.what == "breath") {
    if (flags.realtime) {
      NERITIC_TRY(const BreathReport report, play_sound(flags));
      return show(flags, report, true);
    }
    NERITIC_TRY(const BreathReport report, analyse_sound(flags));
    return show(flags, report);
  }
  if (flags.what == "gaze") {
    NERITIC_TRY(const GazeReport report, analyse_gaze(flags));
    return show(flags, report);
  }
  return refusal("physio", fmt::format("'{}'", flags.what), "ecg, breath or gaze");
}

}  // namespace neritic::tools
