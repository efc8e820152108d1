// A display of a test: tracks a head and a left hand where it is worn, presses what it is told to,
// and keeps the layers that it was given.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "engine/xr/offscreen.hpp"
#include "testbed/view/dive_input.hpp"

namespace neritic::testbed {

class KeptDisplay final : public xr::Display {
 public:
  explicit KeptDisplay(bool worn) : worn_(worn) {}
  // The action of that name, in the next frame alone.
  void press(std::string_view name) {
    for (const xr::ActionDesc& action : dive_actions())
      pressed_.push_back(action.name == name ? 1.0 : 0.0);
  }
  // The groups of views that it says it will have.
  void ahead(std::vector<xr::ViewGroup> groups) { ahead_ = std::move(groups); }
  // The panel of that name in the last frame; nullptr: there was none.
  const xr::PanelLayer* panel(std::string_view name) const {
    for (const xr::Layer& layer : layers_)
      if (const auto* panel = std::get_if<xr::PanelLayer>(&layer); panel && panel->name == name)
        return panel;
    return nullptr;
  }

  std::vector<xr::ViewGroup> groups_ahead() const override { return ahead_; }
  Result<xr::DisplayFrame> begin_frame(const Pose& world_from_stage) override {
    layers_.clear();
    xr::DisplayFrame frame{.verdict = xr::FrameVerdict::kDraw,
                           .groups = {xr::one_view(64, 64, radians(80.0))}};
    if (!worn_) return frame;
    frame.world_from_head = world_from_stage;
    frame.tracked.hands[0] = world_from_stage * Pose{{-0.1, -0.25, -0.35}};
    return frame;
  }
  Result<xr::ShownPicture> declare(graph::FrameGraph&, const Pose&,
                                   std::span<const xr::Layer> layers) override {
    layers_.assign(layers.begin(), layers.end());
    return xr::ShownPicture{};
  }
  gpu::Frames::SubmitSync sync() const override { return {}; }
  Status end_frame(bool) override { return {}; }
  xr::ActionValues take_actions(const xr::InputClaims&) override {
    return xr::ActionValues(std::exchange(pressed_, {}));
  }

 private:
  bool worn_;
  std::vector<xr::ViewGroup> ahead_;
  std::vector<double> pressed_;
  std::vector<xr::Layer> layers_;
};

}  // namespace neritic::testbed
