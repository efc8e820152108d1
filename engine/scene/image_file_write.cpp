// Writing PNG through libpng. See image_file.hpp.
#include <png.h>

#include <csetjmp>

#include "engine/core/check.hpp"
#include "engine/core/files.hpp"
#include "engine/core/refusal.hpp"
#include "engine/scene/image_file.hpp"

namespace neritic::scene {
namespace {

struct Sink {
  std::vector<std::byte> bytes;
  bool out_of_memory = false;
};

void append(png_structp png, png_bytep data, png_size_t size) {
  auto& sink = *static_cast<Sink*>(png_get_io_ptr(png));
  try {
    const auto* from = reinterpret_cast<const std::byte*>(data);
    sink.bytes.insert(sink.bytes.end(), from, from + size);
  } catch (const std::bad_alloc&) {
    sink.out_of_memory = true;  // no exception may cross libpng's frames
  }
}
void flush_nothing(png_structp) {}
void stay_silent(png_structp, png_const_charp) {}

struct Layout {
  std::uint32_t width, height, channels;
  int bits;
};

// Only plain values live in this frame: libpng reports errors by longjmp.
bool encode(const Layout& layout, const png_byte* pixels, Sink* sink) {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, stay_silent);
  if (!png) return false;
  png_infop info = png_create_info_struct(png);
  if (!info || setjmp(png_jmpbuf(png))) {
    png_destroy_write_struct(&png, &info);
    return false;
  }
  png_set_write_fn(png, sink, append, flush_nothing);
  const int color = layout.channels == 1   ? PNG_COLOR_TYPE_GRAY
                    : layout.channels == 3 ? PNG_COLOR_TYPE_RGB
                                           : PNG_COLOR_TYPE_RGBA;
  png_set_IHDR(png, info, layout.width, layout.height, layout.bits, color, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  // Fast rather than small: one filter, the lowest level of deflate.
  png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
  png_set_compression_level(png, 1);
  png_set_compression_buffer_size(png, 1 << 20);
  png_write_info(png, info);
  if (layout.bits == 16) png_set_swap(png);  // PNG is big-endian
  const std::size_t stride = std::size_t{layout.width} * layout.channels * (layout.bits / 8);
  for (std::uint32_t y = 0; y < layout.height; ++y) png_write_row(png, pixels + y * stride);
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return true;
}

template <class T>
Status write_png(const std::filesystem::path& path, const Raster<T>& image) {
  NERITIC_CHECK(image.channels == 1 || image.channels == 3 || image.channels == 4, "channels {}",
                image.channels);
  NERITIC_CHECK(image.data.size() == std::size_t{image.width} * image.height * image.channels,
                "{} values for {} x {} x {}", image.data.size(), image.width, image.height,
                image.channels);
  if (image.empty())
    return refusal(path.string(),
                   fmt::format("a picture of {} x {} pixels", image.width, image.height),
                   "at least 1 x 1");
  Sink sink;
  const Layout layout{image.width, image.height, image.channels, int{sizeof(T)} * 8};
  if (!encode(layout, reinterpret_cast<const png_byte*>(image.data.data()), &sink) ||
      sink.out_of_memory)
    return failure(ErrorCode::kIo, "{}: the picture cannot be encoded", path.string());
  return write_file(path, sink.bytes);
}

}  // namespace

Status write_png8(const std::filesystem::path& path, const ImageU8& image) {
  return write_png(path, image);
}
Status write_png16(const std::filesystem::path& path, const ImageU16& image) {
  return write_png(path, image);
}

}  // namespace neritic::scene
