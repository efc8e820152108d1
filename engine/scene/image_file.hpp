// Picture and map files: read PNG (8 and 16 bit), JPEG, WebP and OpenEXR; write PNG and OpenEXR.
// Any thread. Errors are kBadInput with the path and what is accepted; sizes are limited to 32768 x
// 32768 and 2^28 pixels, so a forged header cannot exhaust the memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "engine/core/image.hpp"
#include "engine/core/result.hpp"

namespace neritic::scene {

// channels 0: as in the file; else converted to that many (1, 3 or 4).
Result<ImageU8> read_image8(const std::filesystem::path& path, std::uint32_t channels = 0);
Result<ImageU8> decode_image8(std::span<const std::byte> bytes, const std::string& name,
                              std::uint32_t channels = 0);
// The size in the header of a picture for decode_image8, unchecked; 0 x 0 if there is none.
struct PictureSize {
  std::uint32_t width = 0, height = 0;
};
PictureSize peek_size(std::span<const std::byte> bytes);
// A PNG of at most 8 bits whose numbers mean something (classes, distances), as stored: 1, 2 and 4
// bits unstretched, of a palette the indices and not the colours.
struct PngNumbers {
  ImageU8 image;
  bool palette = false;
};
Result<PngNumbers> read_png_numbers(const std::filesystem::path& path);
Result<PngNumbers> decode_png_numbers(std::span<const std::byte> bytes, const std::string& name);
// 16-bit PNG as stored (an 8-bit file is an error that says so).
Result<ImageU16> read_image16(const std::filesystem::path& path);
Result<ImageU16> decode_image16(std::span<const std::byte> bytes, const std::string& name);
// True where the file is a PNG with 16 bits a channel.
bool is_png16(const std::filesystem::path& path);
// OpenEXR (half, float or uint channels) to float, as large as its display window: 0 where the data
// window (an automatic crop) does not reach, and what lies beyond (overscan) left out; names gives
// the channels in order of the result: R,G,B(,A) or X,Y,Z where the file has those, else
// alphabetical.
struct ExrImage {
  ImageF32 image;
  std::vector<std::string> names;
};
Result<ExrImage> read_exr(const std::filesystem::path& path);
Result<ExrImage> decode_exr(std::span<const std::byte> bytes, const std::string& name);

// Three channels, as half floats.
Status write_exr(const std::filesystem::path& path, const ImageF32& image);
// 1, 3 or 4 channels. Deterministic bytes for the same pixels.
Status write_png8(const std::filesystem::path& path, const ImageU8& image);
Status write_png16(const std::filesystem::path& path, const ImageU16& image);

}  // namespace neritic::scene
