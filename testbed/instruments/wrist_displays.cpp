#include "testbed/instruments/wrist_displays.hpp"

#include "testbed/instruments/instrument_data.hpp"

namespace neritic::testbed {

WristDisplays::WristDisplays(const LivePhysics& physics, hud::Units units)
    : physics_(physics),
      units_(units),
      canvas_(ImageU8(hud::kDisplayWidth_px, hud::kDisplayHeight_px, 4)) {
  for (const PhysicsHuman& human : physics.world().humans())
    places_.push_back({human.object, kWristDisplay, hud::kDisplayWidth_px, hud::kDisplayHeight_px});
  displays_.resize(places_.size());
  follow();
}

void WristDisplays::follow() {
  const sim::Snapshot<PhysicsState>& snapshot = physics_.shown_snapshot();
  for (std::size_t i = 0; i < displays_.size(); ++i)
    displays_[i].now = hud::shown_on_display(units_, instrument_data(physics_.world(), i, snapshot),
                                             snapshot.time_s);
}

scene::ObjectPictures::Picture WristDisplays::picture(std::size_t place) {
  Display& display = displays_[place];
  if (display.picture.number > 0 && display.now == display.drawn) return display.picture;
  std::vector<hud::TextMark> marks;
  canvas_.clear();
  hud::Painter painter(canvas_, 1.0, marks);
  hud::draw_display(painter, display.now);
  display.drawn = display.now;
  display.pixels = canvas_.image();
  display.picture = {&display.pixels, display.picture.number + 1};
  return display.picture;
}

std::unique_ptr<WristDisplays> wrist_displays(const LivePhysics* physics, hud::Units units) {
  if (!physics || physics->world().humans().empty()) return nullptr;
  return std::make_unique<WristDisplays>(*physics, units);
}

std::span<const scene::PicturePlace> picture_places(const scene::ObjectPictures* pictures) {
  return pictures ? pictures->places() : std::span<const scene::PicturePlace>();
}

}  // namespace neritic::testbed
