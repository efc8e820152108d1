// The list of the controls, over the picture: in as many columns and pages as the window needs.
// Dear ImGui calls. Rendering thread.
#pragma once

#include <span>

#include "engine/xr/actions.hpp"

namespace neritic::testbed {

// Draws a page, from 0. Gives the number of pages at this window's size.
std::size_t draw_help(std::span<const xr::ActionDesc> actions, std::size_t page, float scale);

}  // namespace neritic::testbed
