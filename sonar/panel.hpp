// The polar picture of a sonar image: a fan with range rings, bearing lines, numbers and a colour
// scale. For people only; it never changes the data. Pure function; any thread.
#pragma once

#include <string>

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
};

// RGB. Port is left, ahead is up.
ImageU8 draw_panel(const BeamGrid& grid, const SonarImage& image, const PanelOptions& options = {});

// The panel's full scale for an image (PanelOptions::full_scale or the automatic one; 1 for
// silence).
double panel_full_scale(const SonarImage& image, const PanelOptions& options);

}  // namespace neritic::sonar
