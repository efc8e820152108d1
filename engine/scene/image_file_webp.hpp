// WebP through libwebp. image_file.hpp is the interface for everybody else. Any thread.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "engine/core/image.hpp"
#include "engine/core/result.hpp"
#include "engine/scene/image_file.hpp"

namespace neritic::scene {

bool is_webp(std::span<const std::byte> bytes);
// As the header says; 0 x 0 where it is broken.
PictureSize webp_size(std::span<const std::byte> bytes);

// channels 0: as in the file (3 or 4); else 1 (luma of BT.601), 3 or 4. Animations are refused.
Result<ImageU8> decode_webp(std::span<const std::byte> bytes, const std::string& name,
                            std::uint32_t channels);

}  // namespace neritic::scene
