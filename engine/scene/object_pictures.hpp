// Pictures on objects that change while a scene runs: the displays of instruments. A program that
// has some gives them to who draws the scene; each object shows its own, on its model's materials
// of that name (Material::picture). One thread.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "engine/core/image.hpp"

namespace neritic::scene {

// Where a picture is shown, and its size.
struct PicturePlace {
  std::size_t object = 0;  // of the scene
  std::string name;        // of its model's materials
  std::uint32_t width = 1, height = 1;
};

class ObjectPictures {
 public:
  struct Picture {
    // RGBA, sRGB-encoded, opaque, of the place's size, rows from the top. Until the next call.
    const ImageU8* pixels = nullptr;
    // Another number is another picture; not 0.
    std::uint64_t number = 0;
  };
  virtual ~ObjectPictures() = default;
  // The same list at any time.
  virtual std::span<const PicturePlace> places() const = 0;
  // Pictures are those of now, until the next call.
  virtual void follow() = 0;
  // Asked only of places that are in sight. place: an index into places().
  virtual Picture picture(std::size_t place) = 0;
};

}  // namespace neritic::scene
