#include "testbed/view/screenshots.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/image.hpp"
#include "engine/scene/image_file.hpp"

namespace neritic::testbed {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxShots = 10000;

// The first free name in the current folder.
fs::path free_name() {
  for (int i = 1; i < kMaxShots; ++i) {
    fs::path path = fmt::format("neritic_{:04}.png", i);
    std::error_code error;
    if (!fs::exists(path, error)) return path;
  }
  return "neritic_last.png";
}

ImageU8 rgb_of(std::span<const std::uint8_t> texels, std::uint32_t width, std::uint32_t height,
               bool bgra) {
  ImageU8 image(width, height, 3);
  const std::size_t pixels = std::size_t{width} * height;
  for (std::size_t i = 0; i < pixels; ++i)
    for (std::size_t c = 0; c < 3; ++c) image.data[3 * i + c] = texels[4 * i + (bgra ? 2 - c : c)];
  return image;
}

// A part of the picture, at least a pixel.
ImageU8 cut(const ImageU8& image, const xr::PanelPart& part) {
  const auto edge = [](double at, std::uint32_t size) {
    return static_cast<std::uint32_t>(std::clamp(std::round(at * size), 0.0, size * 1.0));
  };
  const std::uint32_t left = std::min(edge(part.left, image.width), image.width - 1);
  const std::uint32_t top = std::min(edge(part.top, image.height), image.height - 1);
  const std::uint32_t right = std::max(edge(part.right, image.width), left + 1);
  const std::uint32_t bottom = std::max(edge(part.bottom, image.height), top + 1);
  ImageU8 out(right - left, bottom - top, image.channels);
  for (std::uint32_t y = top; y < bottom; ++y)
    std::copy_n(&image.at(left, y), std::size_t{out.width} * image.channels, &out.at(0, y - top));
  return out;
}

}  // namespace

Status Screenshots::declare(graph::FrameGraph& graph, const xr::ShownPicture& shown, bool last) {
  const bool final_one = !final_path_.empty();
  if (last && final_one && shot_ && shot_->by_key) NERITIC_TRY_STATUS(write());
  if (!(final_one || asked_) || (shot_ && shot_->by_key)) return {};
  const auto asked = std::exchange(asked_, std::nullopt);
  const bool by_key = asked.has_value();
  if (!shown.readable) {
    if (!by_key)
      return failure(ErrorCode::kUnsupported,
                     "--screenshot: the images of this window cannot be read; use --headless");
    note_ = "no screenshot: this window's images cannot be read";
    return {};
  }
  Shot shot;
  shot.path = by_key ? free_name() : final_path_;
  shot.width = shown.width;
  shot.height = shown.height;
  shot.by_key = by_key;
  shot.part = asked.value_or(xr::PanelPart{});
  shot.bgra = shown.format == VK_FORMAT_B8G8R8A8_UNORM;
  NERITIC_TRY(shot.texels, readback_.declare(graph, device_, "screenshot", shown.image,
                                             shown.format, shown.width, shown.height, 1));
  shot_ = std::move(shot);
  return {};
}

void Screenshots::submitted(std::uint64_t value) {
  if (shot_ && shot_->done == 0) shot_->done = value;
}

Status Screenshots::write_done(std::uint64_t completed) {
  // The one of the last frame is replaced by the next frame's until the end.
  if (!shot_ || !shot_->by_key || shot_->done == 0 || shot_->done > completed) return {};
  return write();
}

Status Screenshots::finish() {
  return shot_ && shot_->done > 0 ? write() : Status();
}

Status Screenshots::write() {
  NERITIC_TRY_STATUS(frames_.wait(shot_->done));
  const Status written = scene::write_png8(
      shot_->path,
      cut(rgb_of(shot_->texels->mapped<std::uint8_t>(), shot_->width, shot_->height, shot_->bgra),
          shot_->part));
  const bool by_key = shot_->by_key;
  note_ =
      written.ok() ? "wrote " + shot_->path.string() : "no screenshot: " + written.error().message;
  shot_.reset();
  return by_key ? Status() : written;
}

}  // namespace neritic::testbed
