// An instrument: takes a diver's data as it comes and keeps the picture of one layout, with alarms
// and the last minute. A picture that would stay the same is not drawn again, and costs no
// allocation. One owner, one thread.
#pragma once

#include <memory>

#include "hud/draw.hpp"
#include "hud/gas_left.hpp"

namespace neritic::hud {

class Hud {
 public:
  // height_px: of the picture; the width follows from the layout.
  Hud(LayoutKind layout, Units units, std::uint32_t height_px);

  // From the next update on the picture has this height; alarms and the last minute stay.
  void resize(std::uint32_t height_px);
  // Alarms, the last minute and the mean of the breathing go on, and nothing is drawn.
  // seen_s: of the viewer's clock, by which alarms last and flash; the rest goes by data.time_s.
  void observe(const DiveData& data, double seen_s);
  // The same, and draws. Whether the picture changed.
  bool update(const DiveData& data, double seen_s, const OperatorData& about = {});

  const Layout& layout() const { return layout_; }
  const AlarmState& alarms() const { return alarms_; }
  // Whether the newest picture has a danger in it, which flashes.
  bool flashes() const { return shown_.flashes; }
  const Shown& shown() const { return shown_; }
  // RGBA, sRGB-encoded, colour multiplied by alpha; transparent before the first update.
  const ImageU8& picture() const { return canvas_.image(); }
  // The texts of the picture.
  std::span<const TextMark> marks() const { return marks_; }

 private:
  const Layout& layout_;
  Units units_;
  double scale_;
  AlarmState alarms_;
  Minute minute_;
  GasLeft gas_left_;
  Shown shown_;
  bool drawn_ = false;
  std::vector<TextMark> marks_;
  draw2d::Canvas canvas_;
};

// The picture with its colour divided by alpha, as PNG files have it.
ImageU8 straight_alpha(const ImageU8& premultiplied);

}  // namespace neritic::hud
