// Any bytes as a PNG, JPEG or OpenEXR picture: an Error in one line, or a picture of its own size.
#include "engine/core/check.hpp"
#include "engine/scene/image_file.hpp"
#include "tests/fuzz/replay.hpp"

namespace {
using namespace neritic;

template <class T>
void check_picture(const Raster<T>& image, std::uint32_t channels) {
  NERITIC_CHECK(!image.empty() && (channels == 0 || image.channels == channels) &&
                    image.data.size() == std::size_t{image.width} * image.height * image.channels,
                "{} x {} x {}: {} values", image.width, image.height, image.channels,
                image.data.size());
}
void check_error(const Error& error) {
  NERITIC_CHECK(
      error.message.starts_with("fuzz.png: ") && error.message.find('\n') == error.message.npos,
      "{}", error.message);
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto bytes = fuzz::as_bytes(data, size);
  if (const auto image = scene::decode_image8(bytes, "fuzz.png", 4); image.ok())
    check_picture(*image, 4);
  else
    check_error(image.error());
  if (const auto image = scene::decode_image16(bytes, "fuzz.png"); image.ok())
    check_picture(*image, 0);
  else
    check_error(image.error());
  if (const auto exr = scene::decode_exr(bytes, "fuzz.png"); exr.ok()) {
    check_picture(exr->image, 0);
    NERITIC_CHECK(exr->names.size() == exr->image.channels, "{} names", exr->names.size());
  } else {
    check_error(exr.error());
  }
  return 0;
}
