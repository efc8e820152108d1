#include "tools/neritic/sonar_picture.hpp"

#include <algorithm>

#include "engine/core/clock.hpp"
#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "engine/core/npy.hpp"
#include "engine/core/refusal.hpp"
#include "engine/scene/image_file.hpp"
#include "sonar/sidescan.hpp"
#include "sonar/write_sonar.hpp"
#include "tools/neritic/flags.hpp"

namespace neritic::tools {
namespace {

namespace fs = std::filesystem;

sonar::PictureLineOptions line_options(const SonarJob& job) {
  const sonar::BeamGrid& grid = job.head.beams;
  return {.n_range = grid.bins.range,
          .range_min_m = grid.limits.range_min_m,
          .range_max_m = grid.limits.range_max_m,
          .beam_along_rad = grid.limits.azimuth_max_rad - grid.limits.azimuth_min_rad,
          .incidence = job.flags.incidence};
}

// The planar depth of each pixel, in metres.
Result<std::vector<float>> depth_of(const SonarJob& job, const fs::path& path,
                                    const sonar::SeabedPicture& picture, SonarNotes& notes) {
  NERITIC_TRY(const sonar::MapFile map, sonar::read_map(path));
  if (map.width != picture.brightness.width || map.height != picture.brightness.height)
    return refusal(path.string(), fmt::format("{} x {} pixels", map.width, map.height),
                   fmt::format("{} x {}, the picture's size", picture.brightness.width,
                               picture.brightness.height));
  note_whole_metres(job, map, notes);
  // Normals have no part in it: those of any depth will do.
  NERITIC_TRY(const sonar::SonarInput in,
              sonar::make_input(map, nullptr, nullptr, picture.intrinsics, job.options));
  std::vector<float> depth(map.pixels(), 0.0f);
  for (std::uint32_t v = 0; v < in.height; ++v)
    for (std::uint32_t u = 0; u < in.width; ++u)
      if (const auto p = sonar::point_of(in, u, v))
        depth[std::size_t{v} * in.width + u] = static_cast<float>(-p->z);
  return depth;
}

}  // namespace

Result<PictureLine> load_picture_line(const SonarJob& job, const sonar::FrameFiles& files,
                                      SonarNotes& notes) {
  const TimeNs start = now_ns();
  const fs::path& path = files.paths[kPictureGroup];
  NERITIC_TRY(const ImageU8 image, scene::read_image8(path));
  sonar::SeabedPicture picture;
  picture.brightness = sonar::brightness_of(image);
  sonar::MapFile shape;
  shape.path = path.string();
  shape.width = image.width;
  shape.height = image.height;
  NERITIC_TRY(picture.intrinsics, frame_intrinsics(job.flags, shape));
  if (job.flags.altitude.empty()) {
    NERITIC_TRY(picture.depth_m, depth_of(job, files.paths[kDepthGroup], picture, notes));
  } else {
    NERITIC_TRY(const auto altitude, parse_numbers("altitude", job.flags.altitude, 1, 1));
    picture.altitude_m = altitude[0];
  }
  PictureLine out;
  NERITIC_TRY(out.line, sonar::sidescan_from_picture(picture, line_options(job)));
  const Intrinsics& k = picture.intrinsics;
  out.facts = {{"kind", job.flags.kind},
               {"method", job.flags.method},
               {"picture", path.filename().string()},
               {"bottom", job.flags.altitude.empty() ? files.paths[kDepthGroup].filename().string()
                                                     : "flat, " + job.flags.altitude + " m below"},
               {"image", {image.width, image.height}},
               {"intrinsics", {{"fx", k.fx}, {"fy", k.fy}, {"cx", k.cx}, {"cy", k.cy}}},
               {"timings_ms", {{"sonar", to_ms(now_ns() - start)}}}};
  const auto is_dark = [](float v) { return !(v > 0.0f); };
  if (std::ranges::all_of(out.line.port, is_dark) &&
      std::ranges::all_of(out.line.starboard, is_dark))
    out.facts["silent"] = "the picture is black, or shows nothing, where the sonar hears";
  return out;
}

Status write_picture_line(const SonarJob& job, const fs::path& folder, PictureLine line) {
  NERITIC_TRY_STATUS(make_folder(folder));
  NERITIC_TRY_STATUS(sonar::remove_earlier_sonar(folder));
  const sonar::PictureLineOptions o = line_options(job);
  std::vector<float> both = line.line.port;
  both.insert(both.end(), line.line.starboard.begin(), line.line.starboard.end());
  NERITIC_TRY_STATUS(write_npy(folder / "sonar.npy", std::span<const float>(both), {2, o.n_range}));
  line.facts["limits"] = {{"range_m", {o.range_min_m, o.range_max_m}},
                          {"beam_along_deg", degrees(o.beam_along_rad)}};
  line.facts["bins"] = {{"range", o.n_range}};
  line.facts["units"] = o.incidence
                            ? "the picture's linear brightness times the cosine of incidence"
                            : "the picture's linear brightness";
  line.facts["layout"] = "sonar.npy [side, range]: 0 port, 1 starboard; 0 nearest";
  line.facts["bytes"] = sonar::sonar_file_sizes(folder);
  return write_json(folder / "sonar.json", line.facts);
}

Status write_waterfall(const SonarJob& job, const std::vector<sonar::FrameFiles>& frames) {
  const sonar::PictureLineOptions o = line_options(job);
  sonar::SidescanRecord record(
      {.n_range = o.n_range, .range_min_m = o.range_min_m, .range_max_m = o.range_max_m});
  for (const sonar::FrameFiles& frame : frames) {
    const fs::path path = job.flags.out / frame.name / "sonar.npy";
    std::error_code error;
    if (!fs::exists(path, error)) continue;  // skipped
    NERITIC_TRY(const NpyArray array, read_npy(path));
    const std::vector<double> values = array.to_doubles();
    if (values.size() != 2 * std::size_t{o.n_range})
      return refusal(path.string(), fmt::format("{} numbers", values.size()),
                     fmt::format("{}", 2 * std::size_t{o.n_range}));
    const std::vector<float> lines(values.begin(), values.end());
    const std::span<const float> both(lines);
    record.append(both.first(o.n_range), both.last(o.n_range), Pose{}, 0.0);
  }
  NERITIC_TRY_STATUS(write_npy(job.flags.out / "waterfall.npy", record.slant_image(),
                               {record.pings(), 2 * std::size_t{o.n_range}}));
  if (job.flags.no_pictures) return {};
  return scene::write_png8(
      job.flags.out / "waterfall.png",
      sonar::draw_slant(record, record.first_returns(), {.title = "SIDE-SCAN FROM PICTURES"}));
}

}  // namespace neritic::tools
