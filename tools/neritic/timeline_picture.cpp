#include "tools/neritic/timeline_picture.hpp"

#include <nlohmann/json.hpp>

#include "tools/common/picture.hpp"

namespace neritic::tools {
namespace {

using nlohmann::json;
using testbed::FrameTimes;

// The run's last frames: more are not told apart.
constexpr std::size_t kFramesInDetail = 3;

double ms_between(TimeNs from, TimeNs to) {
  return six_digits(1e-6 * static_cast<double>(to - from));
}

json phases(const FrameTimes& frame, TimeNs zero) {
  const std::pair<const char*, TimeNs> ends[] = {{"wait", frame.begun},
                                                 {"simulate, declare", frame.declared},
                                                 {"record", frame.recorded},
                                                 {"submit", frame.submitted},
                                                 {"show", frame.ended}};
  json out = json::array();
  TimeNs from = frame.waiting;
  for (const auto& [name, to] : ends) {
    if (to == 0) continue;  // a hidden frame does not get so far
    out.push_back({name, ms_between(zero, from), ms_between(from, to)});
    from = to;
  }
  return out;
}

json detail(const FrameTimes& frame, TimeNs zero) {
  json passes = json::array();
  for (const gpu::PassTime& pass : frame.passes) passes.push_back({pass.name, six_digits(pass.ms)});
  json out{{"number", frame.number},
           {"host", phases(frame, zero)},
           {"device_from_ms", ms_between(zero, frame.submitted)},
           {"passes", passes}};
  if (frame.display_at) out["display_ms"] = ms_between(zero, *frame.display_at);
  return out;
}

}  // namespace

Status write_timeline(const std::filesystem::path& picture, const std::string& title,
                      double budget_ms, const testbed::FrameTimeline& timeline) {
  const auto& frames = timeline.frames();
  json data{{"picture", "timeline"},      {"title", title},
            {"budget_ms", budget_ms},     {"frames", json::array()},
            {"time_s", json::array()},    {"interval_ms", json::array()},
            {"host_ms", json::array()},   {"device_ms", json::array()},
            {"view_scale", json::array()}};
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const FrameTimes &frame = frames[i], &before = frames[i - 1];
    double device_ms = 0.0;
    for (const gpu::PassTime& pass : frame.passes) device_ms += pass.ms;
    data["time_s"].push_back(1e-3 * ms_between(frames.front().begun, frame.begun));
    data["interval_ms"].push_back(ms_between(before.begun, frame.begun));
    data["host_ms"].push_back(ms_between(frame.begun, frame.ended));
    data["device_ms"].push_back(six_digits(device_ms));
    data["view_scale"].push_back(six_digits(frame.view_scale));
  }
  const std::size_t first = frames.size() > kFramesInDetail ? frames.size() - kFramesInDetail : 0;
  for (std::size_t i = first; i < frames.size(); ++i)
    data["frames"].push_back(detail(frames[i], frames[first].waiting));
  NERITIC_TRY(const bool drawn, write_picture(picture, data));
  (void)drawn;  // it has been said
  return {};
}

}  // namespace neritic::tools
