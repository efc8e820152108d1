// See image_file_png.hpp.
#include "engine/scene/image_file_png.hpp"

#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstring>

#include "engine/core/refusal.hpp"
#include "engine/scene/image_file_limits.hpp"

namespace neritic::scene {
namespace {

// Largest ratio that deflate reaches (zlib technical details, J. Gailly, M. Adler: 1032:1).
constexpr std::uint64_t kMaxDeflateRatio = 1032;
// Text and profiles that nobody here reads need not be larger.
constexpr png_alloc_size_t kMaxChunkBytes = 8 << 20;
constexpr png_uint_32 kMaxKeptChunks = 1000;
constexpr std::size_t kBitsAt = 24, kColorTypeAt = 25;  // in the file, of the IHDR chunk

// The treatment of palettes, of fewer than 8 bits and of colours that mean transparent.
enum class Expand { kToColors, kNever };

struct Source {
  std::span<const std::byte> bytes;
  char reason[128] = "";
};

void pull(png_structp png, png_bytep out, png_size_t size) {
  auto& source = *static_cast<Source*>(png_get_io_ptr(png));
  if (size > source.bytes.size()) png_error(png, "the file ends too early");
  std::memcpy(out, source.bytes.data(), size);
  source.bytes = source.bytes.subspan(size);
}
void on_error(png_structp png, png_const_charp reason) {
  auto& source = *static_cast<Source*>(png_get_error_ptr(png));
  std::strncpy(source.reason, reason, sizeof source.reason - 1);
  png_longjmp(png, 1);
}
void ignore_warning(png_structp, png_const_charp) {}

// Owns libpng's two structures. Methods return false after a failure, whose reason is in the
// source; they hold plain values only, since libpng reports errors by longjmp.
class PngReader {
 public:
  explicit PngReader(Source* source) : source_(source) {
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, source, on_error, ignore_warning);
    info_ = png_ ? png_create_info_struct(png_) : nullptr;
  }
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  // Everything before the pixels.
  bool read_header() {
    if (!info_ || setjmp(png_jmpbuf(png_))) return false;
    png_set_read_fn(png_, source_, pull);
    png_set_user_limits(png_, kMaxImageSide, kMaxImageSide);
    png_set_chunk_malloc_max(png_, kMaxChunkBytes);
    png_set_chunk_cache_max(png_, kMaxKeptChunks);
    png_read_info(png_, info_);
    return true;
  }
  // Makes libpng give rows of this number of channels (0: as stored), of 8 or 16 bits.
  bool set_layout(std::uint32_t channels, int bits, Expand expand) {
    if (setjmp(png_jmpbuf(png_))) return false;
    if (expand == Expand::kToColors) png_set_expand(png_);
    png_set_packing(png_);  // numbers of fewer than 8 bits, where they stay: one a byte
    if (bits == 8) png_set_scale_16(png_);
    if (bits == 16) png_set_swap(png_);  // PNG is big-endian
    const bool gray = (png_get_color_type(png_, info_) & PNG_COLOR_MASK_COLOR) == 0;
    if (channels >= 3 && gray) png_set_gray_to_rgb(png_);
    if (channels == 1 && !gray) png_set_rgb_to_gray(png_, PNG_ERROR_ACTION_NONE, -1, -1);
    if (channels == 1 || channels == 3) png_set_strip_alpha(png_);
    if (channels == 4) png_set_add_alpha(png_, bits == 8 ? 0xff : 0xffff, PNG_FILLER_AFTER);
    n_passes_ = png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    return true;
  }
  // out: rows of row_bytes().
  bool read_rows(png_bytep out) {
    if (setjmp(png_jmpbuf(png_))) return false;
    for (int pass = 0; pass < n_passes_; ++pass)
      for (std::uint32_t y = 0; y < height(); ++y)
        png_read_row(png_, out + std::size_t{y} * row_bytes(), nullptr);
    return true;  // what follows the pixels is of no use here
  }
  std::uint32_t width() const { return png_get_image_width(png_, info_); }
  std::uint32_t height() const { return png_get_image_height(png_, info_); }
  std::uint32_t channels() const { return png_get_channels(png_, info_); }
  std::size_t row_bytes() const { return png_get_rowbytes(png_, info_); }

 private:
  Source* source_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  int n_passes_ = 1;
};

template <class T>
Result<Raster<T>> decode_png(std::span<const std::byte> bytes, const std::string& name,
                             std::uint32_t channels, Expand expand) {
  const auto broken = [&](const Source& source) {
    return refusal(name, fmt::format("a broken PNG ({})", source.reason), "a whole picture");
  };
  Source source{bytes};
  PngReader reader(&source);
  if (!reader.read_header()) return broken(source);
  const std::uint64_t pixels = std::uint64_t{reader.width()} * reader.height();
  if (pixels > kMaxImagePixels)
    return refusal(name, fmt::format("{} x {} pixels", reader.width(), reader.height()),
                   "at most 2^28 in all");
  // row_bytes: still as stored.
  if (std::uint64_t{reader.row_bytes()} * reader.height() > bytes.size() * kMaxDeflateRatio)
    return refusal(name, fmt::format("{} x {} pixels", reader.width(), reader.height()),
                   fmt::format("as many as can come from {} bytes", bytes.size()));
  if (!reader.set_layout(channels, 8 * sizeof(T), expand)) return broken(source);
  note_if_heavy(name, reader.width(), reader.height());
  Raster<T> image(reader.width(), reader.height(), reader.channels());
  if (reader.row_bytes() * reader.height() != image.data.size() * sizeof(T))
    return refusal(name, "a PNG of an unknown layout",
                   "grey, RGB or a palette, with or without alpha");
  if (!reader.read_rows(reinterpret_cast<png_bytep>(image.data.data()))) return broken(source);
  return image;
}

std::uint32_t big_endian(std::span<const std::byte> bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i)
    value = value << 8 | std::to_integer<std::uint32_t>(bytes[at + i]);
  return value;
}

// Said here in full: libpng only says "invalid IHDR data".
Status check_size(std::span<const std::byte> bytes, const std::string& name) {
  if (!is_png(bytes))
    return refusal(name, fmt::format("{} bytes of another kind", bytes.size()), "a PNG picture");
  const auto [width, height] = png_size(bytes);
  if (width == 0 || height == 0 || width > kMaxImageSide || height > kMaxImageSide)
    return refusal(name, fmt::format("{} x {} pixels", width, height),
                   fmt::format("1 x 1 to {} x {}", kMaxImageSide, kMaxImageSide));
  return {};
}

}  // namespace

bool is_png(std::span<const std::byte> bytes) {
  static constexpr unsigned char kSignature[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  constexpr std::size_t kShortest = 33;  // the signature and the IHDR chunk
  return bytes.size() >= kShortest && std::memcmp(bytes.data(), kSignature, sizeof kSignature) == 0;
}

int png_bits(std::span<const std::byte> bytes) {
  return std::to_integer<int>(bytes[kBitsAt]);
}

PictureSize png_size(std::span<const std::byte> bytes) {
  return {big_endian(bytes, 16), big_endian(bytes, 20)};
}

Result<ImageU8> decode_png8(std::span<const std::byte> bytes, const std::string& name,
                            std::uint32_t channels) {
  NERITIC_TRY_STATUS(check_size(bytes, name));
  return decode_png<std::uint8_t>(bytes, name, channels, Expand::kToColors);
}

Result<PngNumbers> decode_png_numbers(std::span<const std::byte> bytes, const std::string& name) {
  NERITIC_TRY_STATUS(check_size(bytes, name));
  if (png_bits(bytes) > 8)
    return refusal(name, fmt::format("{} bits a channel", png_bits(bytes)), "at most 8");
  PngNumbers out;
  NERITIC_TRY(out.image, decode_png<std::uint8_t>(bytes, name, 0, Expand::kNever));
  out.palette = std::to_integer<int>(bytes[kColorTypeAt]) == PNG_COLOR_TYPE_PALETTE;
  return out;
}

Result<ImageU16> decode_png16(std::span<const std::byte> bytes, const std::string& name) {
  NERITIC_TRY_STATUS(check_size(bytes, name));
  if (png_bits(bytes) != 16)
    return refusal(name, fmt::format("{} bits a channel", png_bits(bytes)), "a 16-bit PNG");
  return decode_png<std::uint16_t>(bytes, name, 0, Expand::kToColors);
}

}  // namespace neritic::scene
