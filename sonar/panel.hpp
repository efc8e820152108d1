// The polar picture of a sonar image: a fan with range rings, bearing lines, numbers and a colour
// scale. It is drawn from a copy of the data and never changes them.
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
  // The value drawn in full brightness; 0: the 99.5th percentile of the values above zero. The
  // panel states which.
  double full_scale = 0.0;
  // Shown brightness = (value / full scale)^gamma. Display only; stated on the panel.
  double gamma = 0.6;
  // Above 0: brightness is linear in decibels instead, from full scale down to span_db below it.
  double span_db = 0.0;
  // false: the fan and its lines without text, for pictures too small to read text on.
  bool words = true;
};
// The brightness in which a value is drawn, 0 to 1.
double panel_brightness(double value, double full_scale, const PanelOptions& options);

// Draws the images of one sonar. The constructor computes the cells that each pixel shows and the
// lines over them once, so that a live display can draw every ping. Several threads may call draw.
class PolarPanel {
 public:
  explicit PolarPanel(const BeamGrid& grid, const PanelOptions& options = {});
  // RGB. Port is left, ahead is up.
  ImageU8 draw(const SonarImage& image) const;

 private:
  struct Fan {  // a pixel of the fan and the cells of its four samples
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

// The panel's full scale for an image: PanelOptions::full_scale or the automatic one.
double panel_full_scale(const SonarImage& image, const PanelOptions& options);

}  // namespace neritic::sonar
