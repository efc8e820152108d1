// The object under a place of the picture: its name, class and distance, from the labels and the
// depth of that frame's G-buffer. Costs two transfers in the frame of a click alone. Rendering
// thread.
#pragma once

#include <optional>
#include <string>

#include "engine/gpu/device.hpp"
#include "engine/scene/scene.hpp"
#include "hud/numbers.hpp"
#include "testbed/sensors/readback.hpp"
#include "testbed/sensors/sensor_frame.hpp"

namespace neritic::testbed {

struct Picked {
  Vec2 at{0.0};       // in the picture, 0 to 1 from its left and its top
  std::string words;  // "rov, vehicle, 4.31 m"; "open water"
};

class Picker {
 public:
  explicit Picker(gpu::Device& device) : device_(device) {}
  // In the next frame; tangents: of the view.
  void ask(const Vec2& at, const FrustumTangents& tangents) { ask(at, tangents, tangents); }
  // shown: a part of the view, in which the place is.
  void ask(const Vec2& at, const FrustumTangents& tangents, const FrustumTangents& shown);
  // views: of the picture's group.
  Status declare(graph::FrameGraph& graph, const SensorFrame::Views& views);
  void submitted(std::uint64_t value);
  // Once, when that frame is done.
  std::optional<Picked> take(std::uint64_t completed, const scene::Scene& scene, hud::Units units);

 private:
  struct Pick {
    Vec2 at{0.0}, in_view{0.0};  // of what is shown, of the view
    FrustumTangents tangents;
    Readback label, depth;
    std::size_t texel = 0;
    double near_m = 0.0;
    std::uint64_t done = 0;  // the submission that fills it; 0: not submitted yet
    bool declared = false;
  };
  gpu::Device& device_;
  ReadbackPool readback_;
  std::optional<Pick> pick_;
};

// The words of a label: an object's name and class. Empty: nothing is there.
std::string words_of_label(const scene::Scene& scene, std::uint16_t class_id,
                           std::uint16_t instance);
// The words of a label with how far it is.
std::string picked_words(const std::string& label, double distance_m, hud::Units units);

}  // namespace neritic::testbed
