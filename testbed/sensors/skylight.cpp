#include "testbed/sensors/skylight.hpp"

#include <algorithm>

#include "testbed/sensors/view_sensor.hpp"

namespace neritic::testbed {

Result<const render::SkylightGrid*> Skylight::grid(const FrameParts& frame) {
  if (!frame.scene.ambient || !frame.scene.ambient->skylight) return nullptr;
  const std::uint64_t still = frame.light.still_of(frame);
  if (grid_ && of_ == still) return &*grid_;
  const scene::Skylight& box = *frame.scene.ambient->skylight;
  const auto triangles = render::skylight_triangles(frame.scene, frame.state, frame.still, box);
  render::SkylightGrid grid = render::skylight_grid(box, triangles);
  if (cells_) frame.device.wait_idle();  // a frame in flight may still read it
  NERITIC_TRY(cells_,
              gpu::Buffer::create(frame.device, {.name = "skylight",
                                                 .size = grid.open.size() * sizeof(float),
                                                 .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                                                 .memory = gpu::MemoryUse::kUpload}));
  std::ranges::copy(grid.open, cells_.mapped<float>().begin());
  grid_ = std::move(grid);
  of_ = still;
  return &*grid_;
}

}  // namespace neritic::testbed
