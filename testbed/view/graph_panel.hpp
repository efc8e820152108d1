// An operator's graphs: any numbers of the run over the last two minutes, one below the other,
// chosen from a list. Dear ImGui calls. Rendering thread.
#pragma once

#include <string>
#include <vector>

#include "testbed/view/panel_layout.hpp"
#include "testbed/view/run_numbers.hpp"

namespace neritic::testbed {

inline constexpr std::size_t kMostGraphs = 4;

// The numbers that are shown, by name; empty: not chosen yet.
struct GraphChoice {
  std::vector<std::string> names;
};

PanelWish graphs_wish(const GraphChoice& choice);
// Adds and removes what the user clicks.
void draw_graphs(const RunNumbers& numbers, GraphChoice& choice, const PanelRect& rect,
                 hud::Units units, float scale);
// "diver depth   16.2 m   (15.9 to 16.3)"; low above high: nothing is known.
std::string caption(const RunNumber& number, double low, double high, hud::Units units);

}  // namespace neritic::testbed
