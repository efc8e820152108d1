// The list of the controls, over the picture: in as many columns and pages as the window needs.
// Dear ImGui calls. Rendering thread.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/xr/actions.hpp"

namespace neritic::testbed {

struct HelpRow {
  std::string controls, help;
};
// As the actions are bound. Those without a help or a control are left out.
std::vector<HelpRow> help_rows(std::span<const xr::ActionDesc> actions);
// Draws a page, from 0. Gives the number of pages at this window's size.
std::size_t draw_help(std::span<const xr::ActionDesc> actions, std::size_t page, float scale);

}  // namespace neritic::testbed
