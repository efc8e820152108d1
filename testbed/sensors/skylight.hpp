// The skylight of a session's scene: its grid, made once and kept while what stands still is where
// it was. Private to testbed/sensors; rendering thread.
#pragma once

#include <cstdint>
#include <optional>

#include "engine/render/renderer.hpp"
#include "engine/render/skylight.hpp"

namespace neritic::testbed {

struct FrameParts;

class Skylight {
 public:
  // The grid of the scene's [ambient.skylight]; nullptr where it names none.
  Result<const render::SkylightGrid*> grid(const FrameParts& frame);
  // The grid's cells for shaders; after grid().
  const gpu::Buffer& cells() const { return cells_; }

 private:
  std::optional<render::SkylightGrid> grid_;
  std::uint64_t of_ = 0;  // render::still_hash of what it was made of
  gpu::Buffer cells_;
};

}  // namespace neritic::testbed
