// Contact sheets: captioned pictures beside each other.
#include <algorithm>
#include <cmath>

#include "engine/draw2d/canvas.hpp"
#include "testbed/output/pictures.hpp"

namespace neritic::testbed {
namespace {

constexpr draw2d::Color kPaper{0.055f, 0.075f, 0.10f, 1.0f}, kInk{0.80f, 0.88f, 0.92f, 1.0f};
constexpr double kCaption_px = 11.0;
constexpr std::uint32_t kCaptionBand_px = 26, kGap_px = 10;

struct Slot {
  std::uint32_t x, y, width, height;
};

// Copies the tile's picture into the middle of its slot, shrunk to fit.
void place(ImageU8& out, const Tile& tile, const Slot& slot) {
  if (tile.image.empty()) return;
  const std::uint32_t room = slot.height - kCaptionBand_px;
  const double scale =
      std::min(double(slot.width) / tile.image.width, double(room) / tile.image.height);
  const auto w = std::max<std::uint32_t>(1, static_cast<std::uint32_t>(tile.image.width * scale));
  const auto h = std::max<std::uint32_t>(1, static_cast<std::uint32_t>(tile.image.height * scale));
  const ImageU8 small = resized(tile.image, w, h);
  const std::uint32_t left = slot.x + (slot.width - w) / 2,
                      top = slot.y + kCaptionBand_px + (room - h) / 2;
  for (std::uint32_t v = 0; v < h; ++v)
    std::copy_n(&small.data[std::size_t{v} * w * 3], std::size_t{w} * 3,
                &out.data[(std::size_t{top + v} * out.width + left) * 3]);
}

// The caption, cut to the slot's width, then the colours of its key as far as there is room, then
// the number of those left out.
void write_caption(draw2d::Canvas& canvas, const Tile& tile, const Slot& slot) {
  constexpr double kWord_px = 9.0, kSwatch_px = 11.0, kSpace_px = 4.0, kAfter_px = 9.0;
  const double y = slot.y + kCaptionBand_px - 9.0;
  double x = slot.x + 2.0;
  const std::string caption = canvas.shortened(kCaption_px, tile.caption, slot.width - 4.0);
  canvas.text(x, y, kCaption_px, caption, kInk);
  x += canvas.text_width(kCaption_px, caption) + 2.0 * kAfter_px;
  for (std::size_t i = 0; i < tile.key.size(); ++i) {
    const auto& [color, word] = tile.key[i];
    const double width = kSwatch_px + kSpace_px + canvas.text_width(kWord_px, word);
    const std::string others = fmt::format("+{}", tile.key.size() - i);
    const double after =
        i + 1 == tile.key.size() ? 0.0 : kAfter_px + canvas.text_width(kWord_px, others);
    if (x + width + after > slot.x + slot.width) {
      canvas.text(x, y - 1.0, kWord_px, others, kInk);
      return;
    }
    x = std::round(x);
    canvas.fill_rectangle(x, y - kSwatch_px, x + kSwatch_px, y,
                          {color[0] / 255.0f, color[1] / 255.0f, color[2] / 255.0f});
    canvas.text(x + kSwatch_px + kSpace_px, y - 1.0, kWord_px, word, kInk);
    x += width + kAfter_px;
  }
}

ImageU8 draw(std::uint32_t width, std::uint32_t height, const std::vector<Tile>& tiles,
             const std::vector<Slot>& slots) {
  draw2d::Canvas canvas(width, height, kPaper);
  for (std::size_t i = 0; i < tiles.size(); ++i) write_caption(canvas, tiles[i], slots[i]);
  ImageU8 out = canvas.take();
  for (std::size_t i = 0; i < tiles.size(); ++i) place(out, tiles[i], slots[i]);
  return out;
}

}  // namespace

namespace {

// Tiles in one row over the whole width, 16 to 9 but no higher than kHighest_px.
void add_row(std::vector<Slot>& slots, std::uint32_t tiles, std::uint32_t width, std::uint32_t& y) {
  constexpr std::uint32_t kHighest_px = 360;
  const std::uint32_t slot = (width - kGap_px) / tiles - kGap_px;
  const std::uint32_t height = std::min(slot * 9 / 16, kHighest_px) + kCaptionBand_px;
  for (std::uint32_t k = 0; k < tiles; ++k)
    slots.push_back({kGap_px + k * (slot + kGap_px), y, slot, height});
  y += height + kGap_px;
}

}  // namespace

ImageU8 contact_sheet(const std::vector<Tile>& tiles) {
  // The large tile is as high as the three small ones beside it: 3 heights + 2 (caption + gap).
  constexpr std::uint32_t kSmallWidth = 420, kSmallHeight = 236 + kCaptionBand_px, kBeside = 3;
  constexpr std::uint32_t kLargeHeight = kBeside * kSmallHeight + (kBeside - 1) * kGap_px;
  constexpr std::uint32_t kLargeWidth = (kLargeHeight - kCaptionBand_px) * 16 / 9;
  constexpr std::uint32_t kMostInARow = 4;
  const auto count = static_cast<std::uint32_t>(tiles.size());
  const std::uint32_t beside = kGap_px + kLargeWidth + kGap_px;
  const std::uint32_t width = count > 1 ? beside + kSmallWidth + kGap_px : beside;
  std::vector<Slot> slots{{kGap_px, kGap_px, kLargeWidth, kLargeHeight}};
  for (std::uint32_t i = 1; i < std::min(count, kBeside + 1); ++i)
    slots.push_back(
        {beside, kGap_px + (i - 1) * (kSmallHeight + kGap_px), kSmallWidth, kSmallHeight});
  std::uint32_t y = kGap_px + kLargeHeight + kGap_px;
  std::uint32_t left = count > kBeside + 1 ? count - kBeside - 1 : 0;
  while (left > 0) {  // rows of nearly equal numbers, each filled
    const std::uint32_t rows = (left + kMostInARow - 1) / kMostInARow;
    const std::uint32_t tiles_here = (left + rows - 1) / rows;
    add_row(slots, tiles_here, width, y);
    left -= tiles_here;
  }
  return draw(width, y, tiles, slots);
}

ImageU8 grid_sheet(const std::vector<Tile>& tiles, std::uint32_t columns, std::uint32_t tile_width,
                   std::uint32_t tile_height) {
  const std::uint32_t cell_height = tile_height + kCaptionBand_px + kGap_px,
                      cell_width = tile_width + kGap_px;
  const auto rows = (static_cast<std::uint32_t>(tiles.size()) + columns - 1) / columns;
  std::vector<Slot> slots;
  for (std::uint32_t i = 0; i < tiles.size(); ++i)
    slots.push_back({kGap_px + (i % columns) * cell_width, kGap_px + (i / columns) * cell_height,
                     tile_width, tile_height + kCaptionBand_px});
  return draw(kGap_px + columns * cell_width, kGap_px + std::max(rows, 1u) * cell_height, tiles,
              slots);
}

}  // namespace neritic::testbed
