#include "testbed/output/output.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "engine/core/npz.hpp"
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

// Adds the camera's terms beyond a pinhole, as OpenCV and EMVA 1288 name them.
void add_camera(const ViewImages& view, nlohmann::json& meta) {
  if (view.lens) {
    const auto& k = view.lens->k;
    const auto& p = view.lens->p;
    const bool fisheye = view.lens->model == scene::LensModel::kFisheye;
    const scene::Port& port = view.lens->port;
    const auto is_zero = [](double v) { return v == 0.0; };
    const bool bends =
        fisheye || !std::ranges::all_of(k, is_zero) || !std::ranges::all_of(p, is_zero);
    // A port bends more than these coefficients say, and without a lens they say nothing.
    if (bends || port.kind == scene::PortKind::kNone)
      meta["lens"] = {{"model", fisheye ? "fisheye" : "brown_conrady"},
                      {port.kind == scene::PortKind::kNone ? "opencv" : "opencv_in_air",
                       fisheye ? nlohmann::json{k[0], k[1], k[2], k[3]}
                               : nlohmann::json{k[0], k[1], p[0], p[1], k[2]}}};
    if (port.kind != scene::PortKind::kNone)
      meta["port"] = {{"kind", scene::kPortNames[static_cast<int>(port.kind)]},
                      {"offset", port.offset},
                      {"index", scene::kPortIndex}};
  }
  if (view.sensor)
    meta["sensor"] = {{"gain_db", view.sensor->gain_db},
                      {"full_well_e", view.sensor->full_well_e},
                      {"read_noise_e", view.sensor->read_noise_e},
                      {"bits", view.sensor->bits},
                      {"saturation", view.sensor->saturation()},
                      {"electrons_per_unit", view.sensor->electrons_per_unit()},
                      {"bayer", scene::kBayerNames[static_cast<int>(view.sensor->bayer)]}};
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
  NERITIC_TRY_STATUS(remove_file(folder / "meta.json"));
  for (const char* name :
       {"depth", "normals", "labels", "instances", "motion", "color", "raw", "boxes", "panoptic"})
    for (const char* ending : {".npy", ".npz", ".png", ".exr", ".json"})
      NERITIC_TRY_STATUS(remove_file(folder / (std::string(name) + ending)));
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

constexpr double kDepthPng_m = 0.001;      // a unit
constexpr std::uint16_t kFarther = 65535;  // in a depth.png

ArrayFormat array_format(Packing packing) {
  return packing == Packing::kNone ? ArrayFormat::kNpy : ArrayFormat::kNpz;
}

ImageU16 depth_units(const ImageF32& depth_m) {
  ImageU16 out(depth_m.width, depth_m.height, 1);
  for (std::size_t i = 0; i < depth_m.data.size(); ++i) {
    const double units = std::round(double(depth_m.data[i]) / kDepthPng_m);
    if (std::isfinite(units))
      out.data[i] = static_cast<std::uint16_t>(std::clamp(units, 1.0, double(kFarther)));
  }
  return out;
}

// Colours v of 16 bits: n = 2 v / 65535 - 1, in error by 1.6e-5; black where nothing is.
ImageU16 normal_units(const ImageF32& normals) {
  ImageU16 out(normals.width, normals.height, 3);
  for (std::size_t i = 0; i < normals.data.size(); i += 3) {
    const float* n = &normals.data[i];
    if (n[0] == 0.0f && n[1] == 0.0f && n[2] == 0.0f) continue;
    for (std::size_t k = 0; k < 3; ++k)
      out.data[i + k] = static_cast<std::uint16_t>(
          std::lround((std::clamp(n[k], -1.0f, 1.0f) + 1.0f) * 32767.5f));
  }
  return out;
}

template <class T>
Status write_raster(const std::filesystem::path& folder, const char* name, const Raster<T>& image,
                    Packing packing) {
  if constexpr (std::is_same_v<T, std::uint16_t>)
    if (packing == Packing::kPng)
      return scene::write_png16(folder / (std::string(name) + ".png"), image);
  const std::size_t shape[] = {image.height, image.width, image.channels};
  return write_array(folder, name, array_format(packing), std::span<const T>(image.data),
                     std::span(shape).first(image.channels > 1 ? 3 : 2));
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
                  const FrameFacts& facts, const FrameFormat& format) {
  NERITIC_TRY_STATUS(make_folder(folder));
  NERITIC_TRY_STATUS(remove_earlier_view(folder));
  const auto wants = [&](Dataset dataset, const auto& image) {
    return format.datasets.has(dataset) && !image.empty();
  };
  const Packing packing = format.packing;
  nlohmann::json meta = meta_of(view, facts);
  add_camera(view, meta);
  if (wants(Dataset::kDepth, view.depth)) {
    if (packing == Packing::kPng) {
      NERITIC_TRY_STATUS(write_raster(folder, "depth", depth_units(view.depth), packing));
      meta["depth_png"] = {{"metres_per_unit", kDepthPng_m}, {"nothing", 0}, {"farther", kFarther}};
    } else {
      NERITIC_TRY_STATUS(write_raster(folder, "depth", view.depth, packing));
    }
  }
  if (wants(Dataset::kNormals, view.normals)) {
    if (packing == Packing::kPng) {
      NERITIC_TRY_STATUS(write_raster(folder, "normals", normal_units(view.normals), packing));
      meta["normals_png"] = {{"n", "2 v / 65535 - 1"}, {"nothing", {0, 0, 0}}};
    } else {
      NERITIC_TRY_STATUS(write_raster(folder, "normals", view.normals, packing));
    }
  }
  if (wants(Dataset::kLabels, view.labels))
    NERITIC_TRY_STATUS(write_raster(folder, "labels", view.labels, packing));
  if (wants(Dataset::kInstances, view.instances))
    NERITIC_TRY_STATUS(write_raster(folder, "instances", view.instances, packing));
  if (wants(Dataset::kMotion, view.motion))
    NERITIC_TRY_STATUS(write_raster(folder, "motion", view.motion, packing));
  if (wants(Dataset::kLinear, view.linear))
    NERITIC_TRY_STATUS(scene::write_exr(folder / "color.exr", view.linear));
  if (wants(Dataset::kRaw, view.raw))
    NERITIC_TRY_STATUS(scene::write_png16(folder / "raw.png", view.raw));
  if (wants(Dataset::kColor, view.color))
    NERITIC_TRY_STATUS(scene::write_png8(folder / "color.png", view.color));
  return write_json(folder / "meta.json", meta);
}

sonar::SonarFiles sonar_files(const SonarFrame& frame) {
  return {.grid = frame.grid,
          .image = frame.image,
          .kind = frame.kind,
          .level = frame.level,
          .output = frame.terms.output,
          .label_energy = frame.label_energy ? &*frame.label_energy : nullptr,
          .name = frame.head.empty() ? frame.name : frame.name + " " + frame.head};
}

Status write_sonar_frame(const std::filesystem::path& folder, const SonarFrame& frame,
                         const FrameFacts& facts, const FrameFormat& format) {
  NERITIC_TRY_STATUS(make_folder(folder));
  NERITIC_TRY_STATUS(remove_earlier_sectors(folder));
  for (std::size_t i = 0; i < frame.sectors.size(); ++i)
    NERITIC_TRY_STATUS(
        write_view(frame.sectors.size() == 1 ? folder : folder / fmt::format("sector_{}", i),
                   frame.sectors[i], facts, format));
  if (!frame.heard()) return sonar::remove_earlier_sonar(folder);
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
        {"sound_speed_m_s", frame.sound_speed_m_s},
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
    more["model"]["quality"] =
        sonar::quality_json(*frame.quality, frame.max_error, frame.quality_chosen);
  if (!frame.head.empty()) more["head"] = frame.head;
  if (frame.absorption_db_per_m) more["model"]["absorption_db_per_m"] = *frame.absorption_db_per_m;
  sonar::SonarFiles files = sonar_files(frame);
  files.arrays = array_format(format.packing);
  return sonar::write_sonar(folder, files, more);
}

}  // namespace neritic::testbed
