#include "tools/neritic/render_sheet.hpp"

#include <algorithm>
#include <functional>

#include "engine/core/files.hpp"
#include "engine/scene/image_file.hpp"
#include "sonar/write_sonar.hpp"
#include "testbed/output/output.hpp"
#include "testbed/output/pictures.hpp"

namespace neritic::tools {
using namespace testbed;
namespace {

struct Picture {
  Tile tile;
  std::string file;  // sensor names are unique and every kind ends differently, so these are too
};

bool moves(const ImageF32& motion_px) {
  return std::any_of(motion_px.data.begin(), motion_px.data.end(),
                     [](float v) { return v != 0.0f; });
}

void add_camera(std::vector<Picture>& out, const CameraFrame& camera) {
  for (std::size_t e = 0; e < camera.eyes.size(); ++e) {
    const bool stereo = camera.eyes.size() > 1;
    if (camera.eyes[e].color.empty()) continue;
    const std::string name = stereo ? camera.name + (e == 0 ? "_left" : "_right") : camera.name;
    out.push_back({{camera.eyes[e].color, name}, name + "_color"});
  }
}

// The classes in the picture, the largest in it first.
std::vector<std::pair<Rgb, std::string>> key_of(const ImageU16& labels, const ClassNames& names) {
  std::map<std::uint16_t, std::size_t> pixels;
  for (const std::uint16_t label : labels.data)
    if (label != 0) ++pixels[label];
  std::vector<std::pair<std::uint16_t, std::size_t>> order(pixels.begin(), pixels.end());
  std::ranges::stable_sort(order, std::greater<>(), &std::pair<std::uint16_t, std::size_t>::second);
  std::vector<std::pair<Rgb, std::string>> key;
  for (const auto& [label, count] : order) {
    const auto name = names.find(label);
    key.emplace_back(label_color(label),
                     name != names.end() ? name->second : fmt::format("class {}", label));
  }
  return key;
}

void add_geometry(std::vector<Picture>& out, const CameraFrame& camera, const ClassNames& names) {
  const ViewImages& view = camera.eyes.front();
  const auto add = [&](ImageU8 picture, const std::string& what, const std::string& legend = "") {
    out.push_back(
        {{std::move(picture), camera.name + ": " + what + legend}, camera.name + "_" + what});
  };
  if (const auto span = depth_span(view.depth))
    add(depth_picture(view.depth), "depth",
        fmt::format(", {:.3g} m (bright) to {:.3g} m", span->first, span->second));
  else if (!view.depth.empty())
    add(depth_picture(view.depth), "depth", ": nothing");
  if (!view.normals.empty()) add(normals_picture(view.normals), "normals");
  if (!view.labels.empty()) {
    add(labels_picture(view.labels), "labels");
    out.back().tile.key = key_of(view.labels, names);
  }
  if (!view.instances.empty()) add(labels_picture(view.instances), "instances");
  if (moves(view.motion)) add(motion_picture(view.motion), "motion", " (black: still)");
}

// On a sheet no word of a sonar's own picture could be read, so the caption says what they do.
Tile sonar_tile(const SonarFrame& sonar, const std::string& name) {
  const sonar::Limits& l = sonar.grid.limits;
  sonar::PanelOptions options =
      sonar::panel_options(sonar.kind, sonar.level, sonar.terms.output, sonar.name);
  options.words = false;
  if (sonar.image.n_azimuth == 1) return {sonar::draw_sonar(sonar_files(sonar)), name};
  return {sonar::draw_panel(sonar.grid, sonar.image, options),
          fmt::format("{}: {:g} to {:g} m, {:.3g}\u00b0 wide", name, l.range_min_m, l.range_max_m,
                      degrees(l.azimuth_max_rad - l.azimuth_min_rad))};
}

}  // namespace

Status write_sheet(const std::filesystem::path& out, const FrameResult& result,
                   const ClassNames& names) {
  std::vector<Picture> pictures;
  for (const CameraFrame& camera : result.cameras) add_camera(pictures, camera);
  for (const SonarFrame& sonar : result.sonars) {
    if (!sonar.heard()) continue;
    const std::string name = sonar.head.empty() ? sonar.name : sonar.name + "_" + sonar.head;
    pictures.push_back({sonar_tile(sonar, name), name + "_sonar"});
  }
  if (!result.cameras.empty()) add_geometry(pictures, result.cameras.front(), names);
  NERITIC_TRY_STATUS(make_folder(out / "sheet"));
  std::vector<Tile> tiles;
  for (Picture& picture : pictures) {
    NERITIC_TRY_STATUS(
        scene::write_png8(out / "sheet" / (picture.file + ".png"), picture.tile.image));
    tiles.push_back(std::move(picture.tile));
  }
  return scene::write_png8(out / "sheet.png", contact_sheet(tiles));
}

}  // namespace neritic::tools
