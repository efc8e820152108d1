// See image_file_jpeg.hpp.
#include "engine/scene/image_file_jpeg.hpp"

#include <csetjmp>
#include <cstdio>
// After cstdio, which they need.
#include <jpeglib.h>
// After jpeglib.
#include <jerror.h>

#include "engine/core/refusal.hpp"
#include "engine/scene/image_file_limits.hpp"

namespace neritic::scene {
namespace {

// A block of 8 x 8 pixels needs at least a bit for its DC value, in one component.
constexpr std::uint64_t kMaxPixelsPerByte = 8 * 64, kSlackPixels = 64 * 64;
// A progressive file repeats whole passes over the picture: ten are usual, and a forged file must
// not ask for thousands (libjpeg-turbo, "Two issues with the JPEG standard", 2016).
constexpr int kMaxScans = 100;
constexpr long kMaxWorkBytes = 4L << 30;

struct Errors {
  jpeg_error_mgr base;  // first, so that libjpeg's pointer to it is a pointer to this
  jmp_buf jump;
  char text[JMSG_LENGTH_MAX];
};

[[noreturn]] void leave(j_common_ptr info) {
  auto* errors = reinterpret_cast<Errors*>(info->err);
  errors->base.format_message(info, errors->text);
  std::longjmp(errors->jump, 1);
}

// Warnings are forgiven, apart from those that say that the picture is not whole.
void on_message(j_common_ptr info, int level) {
  const int code = info->err->msg_code;
  if (level < 0 && (code == JWRN_JPEG_EOF || code == JWRN_HIT_MARKER)) leave(info);
}

void on_progress(j_common_ptr info) {
  if (reinterpret_cast<j_decompress_ptr>(info)->input_scan_number <= kMaxScans) return;
  info->err->msg_code = JERR_BAD_PROGRESSION;
  leave(info);
}

// Owns a decompressor. Its methods return false after a failure, whose reason is in error(). They
// hold plain values only, since libjpeg reports errors by longjmp.
class JpegReader {
 public:
  JpegReader() {
    info_.err = jpeg_std_error(&errors_.base);
    errors_.base.error_exit = leave;
    errors_.base.emit_message = on_message;
    progress_.progress_monitor = on_progress;
  }
  ~JpegReader() { jpeg_destroy_decompress(&info_); }  // harmless where nothing was created
  JpegReader(const JpegReader&) = delete;
  JpegReader& operator=(const JpegReader&) = delete;

  bool read_header(std::span<const std::byte> bytes) {
    if (setjmp(errors_.jump)) return false;
    jpeg_create_decompress(&info_);
    info_.progress = &progress_;
    info_.mem->max_memory_to_use = kMaxWorkBytes;
    jpeg_mem_src(&info_, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
    return jpeg_read_header(&info_, TRUE) == JPEG_HEADER_OK;
  }
  // out: rows of width * channels bytes.
  bool read_pixels(std::uint32_t channels, std::uint8_t* out) {
    if (setjmp(errors_.jump)) return false;
    info_.out_color_space = channels == 1 ? JCS_GRAYSCALE : channels == 3 ? JCS_RGB : JCS_EXT_RGBA;
    jpeg_start_decompress(&info_);
    const std::size_t stride = std::size_t{info_.output_width} * channels;
    while (info_.output_scanline < info_.output_height) {
      JSAMPROW row = out + info_.output_scanline * stride;
      jpeg_read_scanlines(&info_, &row, 1);
    }
    jpeg_finish_decompress(&info_);
    return true;
  }
  std::uint32_t width() const { return info_.image_width; }
  std::uint32_t height() const { return info_.image_height; }
  bool gray() const { return info_.jpeg_color_space == JCS_GRAYSCALE; }
  bool four_inks() const {
    return info_.jpeg_color_space == JCS_CMYK || info_.jpeg_color_space == JCS_YCCK;
  }
  const char* error() const { return errors_.text; }

 private:
  jpeg_decompress_struct info_{};
  Errors errors_{};
  jpeg_progress_mgr progress_{};
};

}  // namespace

bool is_jpeg(std::span<const std::byte> bytes) {
  return bytes.size() >= 4 && bytes[0] == std::byte{0xff} && bytes[1] == std::byte{0xd8};
}

PictureSize jpeg_size(std::span<const std::byte> bytes) {
  JpegReader reader;
  if (!reader.read_header(bytes)) return {};
  return {reader.width(), reader.height()};
}

Result<ImageU8> decode_jpeg(std::span<const std::byte> bytes, const std::string& name,
                            std::uint32_t channels) {
  JpegReader reader;
  if (!reader.read_header(bytes))
    return refusal(name, fmt::format("a broken JPEG ({})", reader.error()), "a whole picture");
  const std::uint64_t width = reader.width(), height = reader.height(), pixels = width * height;
  if (width == 0 || height == 0 || width > kMaxImageSide || height > kMaxImageSide ||
      pixels > kMaxImagePixels)
    return refusal(name, fmt::format("{} x {} pixels", width, height),
                   fmt::format("at most {} x {} and 2^28 in all", kMaxImageSide, kMaxImageSide));
  if (pixels > bytes.size() * kMaxPixelsPerByte + kSlackPixels)
    return refusal(name, fmt::format("{} x {} pixels", width, height),
                   fmt::format("as many as can come from {} bytes", bytes.size()));
  note_if_heavy(name, width, height);
  if (reader.four_inks()) return refusal(name, "a JPEG of four inks (CMYK)", "grey or RGB");
  if (channels == 0) channels = reader.gray() ? 1 : 3;
  ImageU8 image(reader.width(), reader.height(), channels);
  if (!reader.read_pixels(channels, image.data.data()))
    return refusal(name, fmt::format("a broken JPEG ({})", reader.error()), "a whole picture");
  return image;
}

}  // namespace neritic::scene
