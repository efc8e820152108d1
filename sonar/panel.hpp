// The polar picture of a sonar image: a fan with range rings, bearing lines, numbers and a colour
// scale. For people only; it never changes the data.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "engine/core/image.hpp"
#include "sonar/beam_grid.hpp"
#include "sonar/reference.hpp"

namespace neritic::sonar {

struct PanelOptions {
  std::uint32_t height_px = 900;
  std::string title = "IMAGING SONAR";
  // Value shown in full brightness; 0: the 99.5th percentile of what is not silent. Stated on the
  // panel either way.
  double full_scale = 0.0;
  // Shown brightness = (value / full scale)^gamma. Display only; stated on the panel.
  double gamma = 0.6;
  // > 0: brightness follows decibels instead, from full scale down to that many below it.
  double span_db = 0.0;
  // false: the fan with its lines alone, for small pictures on which no word could be read.
  bool words = true;
};
// Shown brightness of a value, 0 to 1.
double panel_brightness(double value, double full_scale, const PanelOptions& options);

// Draws one sonar's images. Where each pixel looks and the lines over it are worked out once, so
// that a live display can draw every ping. draw may run on several threads at once.
class PolarPanel {
 public:
  explicit PolarPanel(const BeamGrid& grid, const PanelOptions& options = {});
  // RGB. Port is left, ahead is up.
  ImageU8 draw(const SonarImage& image) const;

 private:
  struct Fan {  // a pixel that shows the wedge, and the cells that its samples fall in
    std::uint32_t pixel;
    std::array<std::uint32_t, 4> cells;  // kOutside: none
  };
  std::uint32_t cell_at(double right_m, double below_m) const;
  BeamGrid grid_;
  PanelOptions options_;
  ImageU8 under_, lines_over_black_, lines_over_white_;
  std::vector<Fan> fan_;
};

ImageU8 draw_panel(const BeamGrid& grid, const SonarImage& image, const PanelOptions& options = {});

// The panel's full scale for an image (PanelOptions::full_scale or the automatic one; 1 for
// silence).
double panel_full_scale(const SonarImage& image, const PanelOptions& options);

}  // namespace neritic::sonar
