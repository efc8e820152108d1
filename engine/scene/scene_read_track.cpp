// Reads a track: waypoints, a lawn-mower pattern or a file, at a speed or at the file's times.
#include <algorithm>

#include "engine/core/refusal.hpp"
#include "engine/scene/number_rows.hpp"
#include "engine/scene/scene_draft.hpp"
#include "engine/scene/scene_reader.hpp"
#include "engine/scene/track_recording.hpp"

namespace neritic::scene {
namespace {

constexpr std::size_t kMaxPoints = 100000;
constexpr double kMaxTime_s = 1e9;
constexpr Interval kTime{-1e6, 1e6, false, false, "seconds"};

std::vector<Vec3> read_waypoints(TableReader& reader) {
  std::vector<Vec3> points;
  for (const auto& row : reader.rows("waypoints_m", {3}, kAnyMetres))
    points.emplace_back(row[0], row[1], row[2]);
  if (points.size() > kMaxPoints || (reader.has("waypoints_m") && points.size() < 2))
    reader.refuse("waypoints_m", fmt::format("2 to {} lists of x, y, z", kMaxPoints));
  return points;
}

std::vector<Vec3> read_lawn_mower(TableReader& parent) {
  const TomlValue* table = parent.table("lawn_mower");
  if (!table) return {};
  TableReader reader(parent.source(), *table, parent.path("lawn_mower"), kLawnMowerKeys);
  LawnMower mower;
  const std::vector<double> area = reader.numbers("area_m", {4}, kAnyMetres);
  if (area.size() != 4 || !(area[0] < area[2] && area[1] < area[3]))
    reader.refuse("area_m", "[x0, z0, x1, z1] in metres, with x0 < x1 and z0 < z1");
  else
    mower = {area[0], area[1], area[2], area[3]};
  mower.depth_m = reader.number("depth_m", 0.0, kAnyMetres);
  mower.spacing_m = reader.number("spacing_m", 1.0, {0, 1e6, true, false, "metres"});
  const bool wide = mower.x1_m - mower.x0_m >= mower.z1_m - mower.z0_m;
  mower.along_x = reader.choice("legs", wide ? "x" : "z", std::to_array<Key>({"x", "z"})) == "x";
  for (const Key key : {"depth_m", "spacing_m"})
    if (!reader.has(key)) reader.refuse(key, "a number of metres");
  if (reader.ok() && leg_count(mower) > kMaxPoints / 2)
    reader.refuse("spacing_m", fmt::format("a spacing that makes at most {} legs", kMaxPoints / 2));
  if (reader.ok()) return waypoints_of(mower);
  parent.fail(reader.status().error());
  return {};
}

Quat attitude_of(const std::vector<double>& row) {
  return from_yaw_pitch_roll(radians(row[4]), radians(row[5]), radians(row[6]));
}

// Rows with times become places, rows without waypoints.
Status take_rows(const std::vector<NumberRow>& rows, const std::string& name, TrackDraft& track,
                 std::vector<Vec3>& points) {
  const std::size_t columns = rows.front().values.size();
  if (rows.size() < 2) return refusal(name, "1 row", "2 or more");
  for (const NumberRow& row : rows) {
    const std::vector<double>& v = row.values;
    if (v.size() != columns || (columns != 3 && columns != 4 && columns != 7))
      return refusal(fmt::format("{}:{}", name, row.line), fmt::format("{} numbers", v.size()),
                     "x, y, z or t_s, x, y, z or t_s, x, y, z, yaw_deg, pitch_deg, roll_deg, the "
                     "same in all rows");
    if (columns == 3) {
      points.emplace_back(v[0], v[1], v[2]);
      continue;
    }
    if (!track.places.empty() && !(v[0] > track.places.back().time_s))
      return refusal(fmt::format("{}:{}", name, row.line),
                     fmt::format("time {} after {}", v[0], track.places.back().time_s),
                     "rising times");
    track.places.push_back({v[0], {v[1], v[2], v[3]}});
    if (columns == 7) track.recorded.push_back(attitude_of(v));
  }
  return {};
}

void read_track_file(TableReader& reader, TrackDraft& track, std::vector<Vec3>& points) {
  const std::filesystem::path file = reader.file("file");
  if (file.empty()) return;
  const RowFormat format{.min_columns = 3,
                         .max_columns = 7,
                         .max_rows = kMaxPoints,
                         .columns = "t_s, x, y, z, yaw_deg, pitch_deg, roll_deg, or x, y, z"};
  const auto rows = read_rows(file, format);
  const Status taken =
      rows.ok() ? take_rows(*rows, file.string(), track, points) : Status(rows.error());
  if (!taken.ok())
    reader.fail({taken.error().code, reader.place("file") + ": " + taken.error().message});
}

// Places and attitudes of a participant of a recorded dive.
void read_track_recording(TableReader& reader, TrackDraft& track) {
  const std::filesystem::path file = reader.file("recording");
  if (file.empty()) return;
  const std::string participant = reader.text("participant", "");
  if (participant.empty()) reader.refuse("participant", "the name of one of the recording's");
  if (!reader.ok()) return;
  auto read = read_recorded_track(file, participant);
  if (!read.ok()) {
    reader.fail({read.error().code, reader.place("recording") + ": " + read.error().message});
    return;
  }
  // From start_s on instead of the recording's own time.
  const double later_s = reader.has("start_s")
                             ? reader.number("start_s", 0.0, kTime) - read->places.front().time_s
                             : 0.0;
  for (Track::Place& place : read->places) place.time_s += later_s;
  track.places = std::move(read->places);
  for (const Track::Attitude& at : read->attitudes) track.recorded.push_back(at.rotation);
}

// Times for points without: by speed_m_s, from start_s on.
void give_times(TableReader& reader, std::vector<Vec3> points, TrackDraft& track) {
  if (!track.places.empty()) {
    for (const Key key : {"speed_m_s", "start_s", "repeat"})
      if (reader.has(key) && !(key == "start_s" && reader.has("recording")))
        reader.refuse(key, "no such key beside a file with times");
    return;
  }
  Waypoints waypoints{std::move(points), 1.0, reader.number("start_s", 0.0, kTime)};
  constexpr Interval kSpeed{0, 1000, true, false, "m/s"};
  waypoints.speed_m_s = reader.number("speed_m_s", 1.0, kSpeed);
  if (!reader.has("speed_m_s")) reader.refuse("speed_m_s", "a number in " + kSpeed.text());
  waypoints.repeat = track.repeat = reader.flag("repeat", false);
  const auto& p = waypoints.points_m;
  const bool meets = waypoints.repeat && p.size() > 1 && p.front() == p.back();
  if (meets || std::adjacent_find(p.begin(), p.end()) != p.end())
    reader.refuse_table("a waypoint at the place of its neighbour", "waypoints apart");
  if (!reader.ok()) return;
  track.places = places_of(waypoints);
  if (!(track.places.back().time_s <= kMaxTime_s))
    reader.refuse("speed_m_s", fmt::format("a speed that ends the course in {:g} s", kMaxTime_s));
}

void read_heading(TableReader& reader, TrackDraft& track) {
  const auto ways = std::to_array<Key>({"along", "fixed"});
  track.heading.along = reader.choice("heading", "along", ways) == "along";
  track.heading.turn_m = reader.number("turn_m", 1.0, {0, 1000, false, false, "metres"});
  if (!track.recorded.empty() && reader.has("heading"))
    reader.refuse("heading", "no such key beside a file with attitudes");
  if ((!track.heading.along || !track.recorded.empty()) && reader.has("turn_m"))
    reader.refuse("turn_m", "no such key unless the heading is along");
}

}  // namespace

std::optional<TrackDraft> read_track(TableReader& parent) {
  const TomlValue* table = parent.table("track");
  if (!table) return std::nullopt;
  TableReader reader(parent.source(), *table, parent.path("track"), kTrackKeys);
  if (int{reader.has("waypoints_m")} + int{reader.has("lawn_mower")} + int{reader.has("file")} +
          int{reader.has("recording")} !=
      1)
    reader.refuse_table("none or more than one of waypoints_m, lawn_mower, file, recording",
                        "one of them");
  if (reader.has("participant") && !reader.has("recording"))
    reader.refuse("participant", "no such key without recording");
  TrackDraft track;
  std::vector<Vec3> points = read_waypoints(reader);
  if (points.empty()) points = read_lawn_mower(reader);
  read_track_file(reader, track, points);
  read_track_recording(reader, track);
  if (reader.ok()) give_times(reader, std::move(points), track);
  read_heading(reader, track);
  if (!reader.ok()) {
    parent.fail(reader.status().error());
    return std::nullopt;
  }
  if (parent.has("position_m")) parent.refuse("position_m", "no such key beside track");
  const bool turns = track.heading.along || !track.recorded.empty();
  for (const Key key : {"look_at_m", "look_at"})
    if (turns && parent.has(key))
      parent.refuse(key, "no such key beside a track unless its heading is \"fixed\"");
  return track;
}

Track make_track(const TrackDraft& draft, const Quat& rotation) {
  if (draft.recorded.empty()) {
    TrackHeading heading = draft.heading;
    heading.rotation = rotation;
    Track track = track_of(draft.places, heading);
    if (draft.repeat) close(track);
    return track;
  }
  Track track{draft.places, {}};
  for (std::size_t i = 0; i < draft.places.size(); ++i)
    track.attitudes.push_back({draft.places[i].time_s, draft.recorded[i] * rotation});
  return track;
}

}  // namespace neritic::scene
