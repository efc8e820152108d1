// The displays of the computers that a scene's divers wear, as pictures on their models: each shows
// the diver's own dive, as hud/display.hpp draws it, at the time to which the physics was followed.
// The same state gives the same picture, whoever looked before. Rendering thread.
#pragma once

#include <memory>
#include <vector>

#include "engine/scene/object_pictures.hpp"
#include "hud/display.hpp"
#include "testbed/motion/live_physics.hpp"

namespace neritic::testbed {

// The name of the picture on a diver's model.
inline constexpr const char* kWristDisplay = "dive computer";

class WristDisplays final : public scene::ObjectPictures {
 public:
  // Borrows the physics, whose objects are those of the scene that is drawn.
  WristDisplays(const LivePhysics& physics, hud::Units units);

  std::span<const scene::PicturePlace> places() const override { return places_; }
  void follow() override;
  Picture picture(std::size_t place) override;

 private:
  struct Display {
    hud::Shown now, drawn;  // drawn: in the picture
    Picture picture;
    ImageU8 pixels;
  };
  const LivePhysics& physics_;
  hud::Units units_;
  std::vector<scene::PicturePlace> places_;  // a diver
  std::vector<Display> displays_;            // a diver
  draw2d::Canvas canvas_;                    // of all, whose fonts stay open
};

// The displays of a dive; nullptr where there is no physics or no diver in it.
std::unique_ptr<WristDisplays> wrist_displays(const LivePhysics* physics, hud::Units units);
// The places of displays that may be absent.
std::span<const scene::PicturePlace> picture_places(const scene::ObjectPictures* pictures);

}  // namespace neritic::testbed
