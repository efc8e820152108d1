#include "tools/neritic/hud_flags.hpp"

#include <algorithm>

#include "engine/core/refusal.hpp"

namespace neritic::tools {
using namespace testbed;

Result<std::vector<hud::LayoutKind>> hud_layouts(const std::string& text) {
  std::vector<hud::LayoutKind> out;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string name = text.substr(begin, end - begin);
    const auto layout = hud::layout_named(name);
    if (!layout)
      return refusal("--hud", fmt::format("'{}'", name),
                     "none, or any of corner, mask, wrist, console with commas between");
    if (std::ranges::find(out, *layout) != out.end())
      return refusal("--hud", fmt::format("{} twice in '{}'", name, text), "each name once");
    out.push_back(*layout);
    begin = end + 1;
  }
  return out;
}

namespace {

Result<std::size_t> find_diver(const std::string& name, const std::vector<PhysicsHuman>& divers) {
  if (name.empty()) return std::size_t{0};
  std::vector<std::string> names;
  for (std::size_t i = 0; i < divers.size(); ++i) {
    if (divers[i].name == name) return i;
    names.push_back(divers[i].name);
  }
  return refusal("--diver", fmt::format("'{}'", name), fmt::format("{}", fmt::join(names, ", ")));
}

}  // namespace

Result<std::optional<DiveHudOptions>> hud_options(const DiveFlags& flags,
                                                  const LivePhysics* physics,
                                                  const std::string& unasked) {
  std::optional<DiveHudOptions> out;
  const std::string asked = flags.hud.empty() ? unasked : flags.hud;
  if (!physics || physics->world().humans().empty()) {
    if (!flags.diver.empty() || !(flags.hud.empty() || flags.hud == "none"))
      return refusal(flags.diver.empty() ? "--hud" : "--diver", "a scene without divers who swim",
                     "a scene with a diver that has physics");
    return out;
  }
  NERITIC_TRY(const std::size_t diver, find_diver(flags.diver, physics->world().humans()));
  DiveHudOptions options{.diver = diver};
  if (flags.units == "imperial") options.units = hud::Units::kImperial;
  if (asked.empty()) return out;
  if (asked != "none") {
    NERITIC_TRY(options.layouts, hud_layouts(asked));
  }
  out = std::move(options);
  return out;
}

}  // namespace neritic::tools
