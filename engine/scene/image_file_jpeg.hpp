// JPEG through libjpeg-turbo: stb_image 2.27's own decoder writes past a table and runs into an
// assertion on forged files (found by fuzzing). Any thread.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "engine/core/image.hpp"
#include "engine/core/result.hpp"
#include "engine/scene/image_file.hpp"

namespace neritic::scene {

bool is_jpeg(std::span<const std::byte> bytes);
// As the header says; 0 x 0 where it is broken.
PictureSize jpeg_size(std::span<const std::byte> bytes);

// channels 0: as in the file (1 or 3); else 1, 3 or 4. Sizes and forged headers are refused as
// image_file.hpp says; a file cut short is an error.
Result<ImageU8> decode_jpeg(std::span<const std::byte> bytes, const std::string& name,
                            std::uint32_t channels);

}  // namespace neritic::scene
