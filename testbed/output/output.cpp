#include "testbed/output/output.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "engine/core/npy.hpp"
#include "engine/scene/image_file.hpp"
#include "shared/raster.h"
#include "sonar/terms_json.hpp"

namespace neritic::testbed {
namespace {

// Finer times are noise.
double to_microsecond(double ms) {
  return std::round(ms * 1000.0) / 1000.0;
}

nlohmann::json passes_of(const FrameFacts& facts) {
  nlohmann::json passes = nlohmann::json::object();
  for (const gpu::PassTime& pass : facts.passes) passes[pass.name] = to_microsecond(pass.ms);
  return passes;
}

nlohmann::json pose_of(const Pose& pose) {
  const Vec3& p = pose.position_m;
  const Quat& q = pose.rotation;
  return {{"position_m", {p.x, p.y, p.z}}, {"rotation_xyzw", {q.x, q.y, q.z, q.w}}};
}

nlohmann::json meta_of(const ViewImages& view, const FrameFacts& facts) {
  return {{"width", view.width},
          {"height", view.height},
          {"fx", view.intrinsics.fx},
          {"fy", view.intrinsics.fy},
          {"cx", view.intrinsics.cx},
          {"cy", view.intrinsics.cy},
          {"pixel_centers", "half"},
          {"near", view.near_m},  // near and time: the file contract's names, metres and seconds
          {"near_m", view.near_m},
          {"pose", pose_of(view.world_from_view)},
          {"frames",
           {{"pose", "world_from_view"},
            {"world", "right-handed, y up, metres, water surface at y = 0"},
            {"view", "x right, y up, z backwards"}}},
          {"time", facts.time_s},
          {"time_s", facts.time_s},
          {"seed", facts.seed},
          {"scene", facts.scene},
          {"device", facts.device},
          {"frame_ms", to_microsecond(facts.frame_ms)},
          {"passes_ms", passes_of(facts)}};
}

// An earlier run's arrays must not be taken for this one's. meta.json goes first and is written
// last: where one is, it describes the arrays beside it.
Status remove_earlier_view(const std::filesystem::path& folder) {
  for (const char* name : {"meta.json", "depth.npy", "normals.npy", "labels.npy", "instances.npy",
                           "motion.npy", "color.png"})
    NERITIC_TRY_STATUS(remove_file(folder / name));
  return {};
}

// Views of a wedge that took more or fewer of them.
Status remove_earlier_sectors(const std::filesystem::path& folder) {
  NERITIC_TRY_STATUS(remove_earlier_view(folder));
  for (std::size_t i = 0; i < shared::kMaxViews; ++i) {
    const std::filesystem::path sector = folder / fmt::format("sector_{}", i);
    NERITIC_TRY_STATUS(remove_earlier_view(sector));
    std::error_code not_empty;
    std::filesystem::remove(sector, not_empty);  // unless there is more in it, of somebody else
  }
  return {};
}

}  // namespace

std::string frame_folder(std::uint32_t number) {
  return fmt::format("frame_{:04}", number);
}

std::filesystem::path sonar_folder(const SonarFrame& frame) {
  const std::filesystem::path sensor = frame.name;
  return frame.head.empty() ? sensor : sensor / frame.head;
}

Status write_view(const std::filesystem::path& folder, const ViewImages& view,
                  const FrameFacts& facts) {
  NERITIC_TRY_STATUS(make_folder(folder));
  NERITIC_TRY_STATUS(remove_earlier_view(folder));
  const std::size_t w = view.width, h = view.height;
  if (!view.depth.empty())
    NERITIC_TRY_STATUS(write_npy(folder / "depth.npy", view.depth.data, {h, w}));
  if (!view.normals.empty())
    NERITIC_TRY_STATUS(write_npy(folder / "normals.npy", view.normals.data, {h, w, 3}));
  if (!view.labels.empty())
    NERITIC_TRY_STATUS(write_npy(folder / "labels.npy", view.labels.data, {h, w}));
  if (!view.instances.empty())
    NERITIC_TRY_STATUS(write_npy(folder / "instances.npy", view.instances.data, {h, w}));
  if (!view.motion.empty())
    NERITIC_TRY_STATUS(write_npy(folder / "motion.npy", view.motion.data, {h, w, 2}));
  if (!view.color.empty()) NERITIC_TRY_STATUS(scene::write_png8(folder / "color.png", view.color));
  return write_json(folder / "meta.json", meta_of(view, facts));
}

sonar::SonarFiles sonar_files(const SonarFrame& frame) {
  return {frame.grid,  frame.image,        frame.kind,
          frame.level, frame.terms.output, frame.label_energy ? &*frame.label_energy : nullptr};
}

Status write_sonar_frame(const std::filesystem::path& folder, const SonarFrame& frame,
                         const FrameFacts& facts) {
  NERITIC_TRY_STATUS(make_folder(folder));
  NERITIC_TRY_STATUS(remove_earlier_sectors(folder));
  for (std::size_t i = 0; i < frame.sectors.size(); ++i)
    NERITIC_TRY_STATUS(
        write_view(frame.sectors.size() == 1 ? folder : folder / fmt::format("sector_{}", i),
                   frame.sectors[i], facts));
  const nlohmann::json gbuffer{
      {"width", frame.gbuffer_width},
      {"height", frame.gbuffer_height},
      {"sampled",
       {{"width", frame.sampled_width},
        {"height", frame.sampled_height},
        {"shift_px_a_row", frame.shift_px}}},
      {"pixels_per_cell",
       {{"requested", frame.pixels_per_cell},
        {"used", {frame.pixels_per_cell_used.x, frame.pixels_per_cell_used.y}}}}};
  nlohmann::json more{
      {"kind", scene::name_of(frame.kind)},
      {"model",
       {{"method", "gpu"},
        {"gather", frame.gather},
        {"fixed_scale", frame.fixed_scale},
        {"sectors", frame.sectors.size()},
        {"gbuffer", gbuffer},
        {"reflectivity",
         frame.reflectivity.empty() ? nlohmann::json(1.0) : nlohmann::json(frame.reflectivity)},
        {"terms", sonar::terms_json(frame.terms)}}},
      {"pose", pose_of(frame.world_from_head)},
      {"time_s", facts.time_s},
      {"seed", facts.seed},
      {"scene", facts.scene},
      {"device", facts.device},
      {"timings_ms", {{"frame", to_microsecond(facts.frame_ms)}, {"passes", passes_of(facts)}}}};
  if (frame.quality != nullptr)
    more["model"]["quality"] = sonar::quality_json(*frame.quality, frame.max_error);
  if (!frame.head.empty()) more["head"] = frame.head;
  if (frame.sound_speed_m_s > 0.0) {
    more["model"]["sound_speed_m_s"] = frame.sound_speed_m_s;
    more["model"]["absorption_db_per_m"] = frame.absorption_db_per_m;
  }
  return sonar::write_sonar(folder, sonar_files(frame), more);
}

}  // namespace neritic::testbed
