// The flags of a dive's instruments.
#pragma once

#include <optional>

#include "testbed/view/dive_hud.hpp"
#include "tools/neritic/commands.hpp"

namespace neritic::tools {

// "corner,wrist"
Result<std::vector<hud::LayoutKind>> hud_layouts(const std::string& text);

// Nothing: no instruments. physics: nullptr where the scene has none. unasked: the layouts of a
// scene with divers where the user names none, as in --hud; empty: none. kBadInput: layouts or
// divers that do not exist.
Result<std::optional<testbed::DiveHudOptions>> hud_options(const DiveFlags& flags,
                                                           const testbed::LivePhysics* physics,
                                                           const std::string& unasked);

}  // namespace neritic::tools
