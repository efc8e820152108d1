// The pictures of a side-scan record. Pure functions; any thread.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "engine/draw2d/axes.hpp"
#include "engine/draw2d/resample.hpp"
#include "sonar/levels.hpp"
#include "sonar/panel.hpp"
#include "sonar/sidescan.hpp"

namespace neritic::sonar {

using namespace draw2d;

namespace {

// The plot's box and the unit of all lettering, for a picture of the given width.
struct Layout {
  double unit;
  PlotBox box;
  std::uint32_t width, height;
};
// narrowest: the part of the width to which a plot that is too high may shrink.
Layout lay_out(const SidescanPictureOptions& options, double box_height_per_width,
               double narrowest = 1.0) {
  const double unit = options.width_px / 1200.0;
  Layout out{unit, {}, options.width_px, 0};
  const double left = std::round(78 * unit), right = std::round(options.width_px - 110 * unit),
               top = std::round(96 * unit), below = std::round(64 * unit);
  const double room = right - left, highest = std::max(1.0, options.max_height_px - top - below);
  const double wide = std::round(
      room * std::clamp(highest / std::max(1e-9, room * box_height_per_width), narrowest, 1.0));
  const double high = std::clamp(std::round(wide * box_height_per_width), 1.0, highest);
  const double at = left + std::floor(0.5 * (room - wide));
  out.box = {at, top, at + wide, top + high};
  // The legend needs a least height.
  out.height = static_cast<std::uint32_t>(top + std::max(high, 240 * unit) + below);
  return out;
}

// How values become brightness: (value / full scale)^gamma. gamma 0.5 draws amplitudes, as devices
// do.
struct Display {
  double full_scale, gamma;
  bool levels;

  void shade(ImageF32& image) const {
    const PanelOptions options{.gamma = gamma};
    for (float& v : image.data)
      if (!std::isnan(v)) v = static_cast<float>(panel_brightness(v, full_scale, options));
  }
  double full_db() const { return 10.0 * std::log10(full_scale); }
  std::string text() const {
    return levels ? fmt::format("full scale {:.0f} dB re 1 \u00b5Pa, gamma {:g}", full_db(), gamma)
                  : fmt::format("full scale {:.2g}, gamma {:g}", full_scale, gamma);
  }
};

// Marks at multiples of 5 dB, placed by their brightness, until they lie too close together.
std::vector<LegendMark> marks_in_db(const Display& display) {
  constexpr double kStep_db = 5.0, kDarkest = 0.1;
  constexpr int kMost = 8;
  const double loudest_db = std::floor(display.full_db() / kStep_db) * kStep_db;
  std::vector<LegendMark> marks;
  for (int i = 0; i < kMost; ++i) {
    const double db = loudest_db - i * kStep_db;
    const double at = std::pow(10.0, display.gamma * (db - display.full_db()) / 10.0);
    if (at >= kDarkest) marks.push_back({at, number_text(db)});
  }
  return marks;
}

Display display_of(const SidescanRecord& record, std::span<const float> values,
                   const SidescanPictureOptions& options) {
  const double full_scale =
      options.full_scale > 0.0 ? options.full_scale : percentile_of_heard(values, 0.99);
  return {full_scale, options.gamma, record.options().levels};
}

// shown_m: how much of the track is shown, if not all.
std::string subtitle(const SidescanRecord& record, const Display& display,
                     std::optional<double> shown_m = {}) {
  const SidescanOptions& o = record.options();
  const std::vector<double> along = record.along_track_m();
  return fmt::format("{} pings over {:.4g} m{}   range {} to {} m a side   {}", record.pings(),
                     along.empty() ? 0.0 : along.back(),
                     shown_m ? fmt::format(", the first {:.4g} m shown", *shown_m) : "",
                     number_text(o.range_min_m), number_text(o.range_max_m), display.text());
}

void finish(Canvas& canvas, const Layout& layout, const Display& display) {
  draw_frame(canvas, layout.box, layout.unit);
  const double bar = layout.width - 82 * layout.unit, top = layout.box.top;
  const PlotBox at{bar, top, bar + 14 * layout.unit, top + 220 * layout.unit};
  // The bar is even in brightness: value = full scale * shade^(1 / gamma).
  if (display.levels)
    draw_legend(canvas, at, ColorMap::kBronze, marks_in_db(display), "dB", layout.unit);
  else
    draw_legend(canvas, at, ColorMap::kBronze, 0.0, 100.0, "display, %", layout.unit);
  canvas.text(layout.box.left + 14 * layout.unit, layout.box.top - 9 * layout.unit,
              10 * layout.unit, "PORT", kPlotText);
  canvas.text(layout.box.right, layout.box.top - 9 * layout.unit, 10 * layout.unit, "STARBOARD",
              kPlotText, Align::kRight);
}

// The rows in reverse order: the newest line on top.
std::vector<float> newest_first(std::span<const float> image, std::size_t rows) {
  const std::size_t width = image.size() / rows;
  std::vector<float> out;
  out.reserve(image.size());
  for (std::size_t row = rows; row-- > 0;)
    out.insert(out.end(), image.begin() + static_cast<std::ptrdiff_t>(row * width),
               image.begin() + static_cast<std::ptrdiff_t>((row + 1) * width));
  return out;
}

// The tracked bottom of one side: -1 port, 1 starboard.
void draw_bottom(Canvas& canvas, const Layout& layout, const SidescanOptions& o,
                 std::span<const double> first_m, double side) {
  const double middle = (layout.box.left + layout.box.right) / 2.0,
               row = layout.box.height() / static_cast<double>(first_m.size());
  const auto x = [&](double r) {
    return middle +
           side * (r - o.range_min_m) / (o.range_max_m - o.range_min_m) * layout.box.width() / 2.0;
  };
  for (std::size_t i = 0; i + 1 < first_m.size(); ++i) {
    if (std::isnan(first_m[i]) || std::isnan(first_m[i + 1])) continue;
    const double y = layout.box.bottom - (static_cast<double>(i) + 0.5) * row;
    canvas.segment(x(first_m[i]), y, x(first_m[i + 1]), y - row, layout.unit,
                   Color{0.45f, 0.85f, 1.0f, 0.55f});
  }
}

// Ticks at ranges on both sides of the middle.
void draw_ranges(Canvas& canvas, const Layout& layout, double from_m, double to_m,
                 const std::string& label) {
  const double middle = (layout.box.left + layout.box.right) / 2.0, unit = layout.unit;
  for (const double tick : nice_ticks(from_m, to_m, 5.0))
    for (const double side : {-1.0, 1.0}) {
      const double x = middle + side * (tick - from_m) / (to_m - from_m) * layout.box.width() / 2.0;
      canvas.segment(x, layout.box.top, x, layout.box.bottom, unit, kPlotLine.with_alpha(0.18f));
      canvas.segment(x, layout.box.bottom + unit, x, layout.box.bottom + 5 * unit, 1.2 * unit,
                     kPlotText.with_alpha(0.8f));
      if (side > 0.0 || x < middle - unit)
        canvas.text(x, layout.box.bottom + 19 * unit, 9 * unit, number_text(tick),
                    kPlotText.with_alpha(0.85f), Align::kCenter);
    }
  canvas.text(middle, layout.box.bottom + 38 * unit, 9.5 * unit, label, kPlotText.with_alpha(0.7f),
              Align::kCenter);
}

// For each of height equal distances along the track, the farthest first: the index of the nearest
// ping.
std::vector<std::size_t> pings_along(std::span<const double> along_m, std::uint32_t height) {
  std::vector<std::size_t> out(height);
  std::size_t ping = 0;
  for (std::uint32_t y = height; y-- > 0;) {
    const double at = along_m.back() * (height - y - 0.5) / height;
    while (ping + 1 < along_m.size() &&
           std::abs(along_m[ping + 1] - at) <= std::abs(along_m[ping] - at))
      ++ping;
    out[y] = ping;
  }
  return out;
}

}  // namespace

ImageU8 draw_slant(const SidescanRecord& record, const FirstReturns& bottom,
                   const SidescanPictureOptions& options) {
  const SidescanOptions& o = record.options();
  const std::size_t pings = record.pings();
  // As on the device: each ping is a line about two pixels high, whatever the speed was.
  const Layout layout = lay_out(options, 2.0 * static_cast<double>(pings) / options.width_px);
  Canvas canvas(layout.width, layout.height, kPlotBackground);
  const Display display = display_of(record, record.slant_image(), options);
  draw_title(canvas, options.title + "   SLANT RANGE", subtitle(record, display), layout.unit);
  if (pings > 0) {
    ImageF32 shades =
        resample_area(newest_first(record.slant_image(), pings), pings, 2 * std::size_t{o.n_range},
                      static_cast<std::uint32_t>(layout.box.width()),
                      static_cast<std::uint32_t>(layout.box.height()));
    display.shade(shades);
    draw_shades(canvas, static_cast<int>(layout.box.left), static_cast<int>(layout.box.top), shades,
                ColorMap::kBronze);
    draw_bottom(canvas, layout, o, bottom.port_m, -1.0);
    draw_bottom(canvas, layout, o, bottom.starboard_m, 1.0);
    draw_left_axis(canvas, layout.box, static_cast<double>(pings), 0.0, "ping", layout.unit);
  }
  draw_ranges(canvas, layout, o.range_min_m, o.range_max_m,
              "slant range, m   (newest ping on top; blue: first bottom return)");
  finish(canvas, layout, display);
  return canvas.take();
}

ImageU8 draw_ground(const SidescanRecord& record, const GroundImage& ground,
                    const SidescanPictureOptions& options) {
  const std::vector<double> along = record.along_track_m();
  const double length_m = along.empty() ? 0.0 : along.back();
  // A long track is drawn to a smaller scale, down to a quarter; a longer one is cut at its end.
  const Layout layout = lay_out(options, length_m / (2.0 * ground.ground_max_m), 0.25);
  Canvas canvas(layout.width, layout.height, kPlotBackground);
  const Display display = display_of(record, ground.intensity, options);
  const double px_per_m = layout.box.width() / (2.0 * ground.ground_max_m);
  const double room_m = layout.box.height() / px_per_m;
  const bool cut = room_m < 0.99 * length_m;  // by more than the rounding of pixels
  const double shown_m = cut ? room_m : length_m;
  draw_title(canvas, options.title + "   GROUND RANGE",
             subtitle(record, display, cut ? std::optional(shown_m) : std::nullopt), layout.unit);
  if (length_m > 0.0) {
    const auto height = static_cast<std::uint32_t>(layout.box.height());
    const std::size_t width = 2 * std::size_t{ground.n_ground};
    std::vector<float> rows;
    const auto all = static_cast<std::uint32_t>(
        std::max<double>(height, std::round(height * length_m / shown_m)));
    const std::vector<std::size_t> pings = pings_along(along, all);
    for (std::uint32_t y = all - height; y < all; ++y)
      rows.insert(rows.end(),
                  ground.intensity.begin() + static_cast<std::ptrdiff_t>(pings[y] * width),
                  ground.intensity.begin() + static_cast<std::ptrdiff_t>((pings[y] + 1) * width));
    ImageF32 shades =
        resample_area(rows, height, width, static_cast<std::uint32_t>(layout.box.width()), height);
    display.shade(shades);
    draw_shades(canvas, static_cast<int>(layout.box.left), static_cast<int>(layout.box.top), shades,
                ColorMap::kBronze);
    draw_left_axis(canvas, layout.box, shown_m, 0.0, "along, m", layout.unit);
    draw_scale_bar(canvas, layout.box.left + 14 * layout.unit, layout.box.bottom - 18 * layout.unit,
                   px_per_m, 0.2 * layout.box.width(), layout.unit);
  }
  draw_ranges(canvas, layout, 0.0, ground.ground_max_m, "ground range, m   (ahead is up)");
  finish(canvas, layout, display);
  return canvas.take();
}

}  // namespace neritic::sonar
