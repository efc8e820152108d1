#include "sonar/write_sonar.hpp"

#include <nlohmann/json.hpp>

#include "engine/core/files.hpp"
#include "engine/core/npy.hpp"
#include "engine/scene/image_file.hpp"

namespace neritic::sonar {

Status write_sonar(const std::filesystem::path& folder, const BeamGrid& grid,
                   const SonarImage& image, const nlohmann::json& facts,
                   const PanelOptions& panel) {
  NERITIC_TRY_STATUS(make_folder(folder));
  const std::size_t rows = image.n_range, columns = image.n_azimuth;
  NERITIC_TRY_STATUS(
      write_npy(folder / "sonar.npy", std::span<const float>(image.intensity), {rows, columns}));
  NERITIC_TRY_STATUS(write_npy(folder / "sonar_labels.npy",
                               std::span<const std::uint16_t>(image.labels), {rows, columns}));
  NERITIC_TRY_STATUS(scene::write_png8(folder / "sonar.png", draw_panel(grid, image, panel)));
  nlohmann::json json = facts;
  const Limits& l = grid.limits;
  json["limits"] = {
      {"range_m", {l.range_min_m, l.range_max_m}},
      {"azimuth_deg", {degrees(l.azimuth_min_rad), degrees(l.azimuth_max_rad)}},
      {"elevation_deg", {degrees(l.elevation_min_rad), degrees(l.elevation_max_rad)}}};
  json["bins"] = {{"range", grid.bins.range},
                  {"azimuth", grid.bins.azimuth},
                  {"elevation", grid.bins.elevation}};
  json["units"] = "mean over elevation bins of the cosine of incidence, 0 to 1 a bin";
  json["layout"] = "sonar.npy [range, azimuth]: row 0 nearest, column 0 full port";
  json["display"] = {{"full_scale", panel_full_scale(image, panel)}, {"gamma", panel.gamma}};
  return write_text(folder / "sonar.json", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

}  // namespace neritic::sonar
