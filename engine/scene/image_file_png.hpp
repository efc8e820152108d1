// PNG through libpng. image_file.hpp is the interface for everybody else. Any thread.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "engine/core/image.hpp"
#include "engine/core/result.hpp"
#include "engine/scene/image_file.hpp"

namespace neritic::scene {

bool is_png(std::span<const std::byte> bytes);
// Bits a channel as stored: 1 to 16. Precondition: is_png.
int png_bits(std::span<const std::byte> bytes);
// As the header says. Precondition: is_png.
PictureSize png_size(std::span<const std::byte> bytes);

// channels 0: as in the file (a palette counts as its colours, 2 is grey with alpha); else 1, 3
// or 4.
Result<ImageU8> decode_png8(std::span<const std::byte> bytes, const std::string& name,
                            std::uint32_t channels);
Result<ImageU16> decode_png16(std::span<const std::byte> bytes, const std::string& name);

}  // namespace neritic::scene
