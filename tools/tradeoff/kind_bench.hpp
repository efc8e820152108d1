// One kind of sonar on a device: its settings rendered from every shot, images and times brought
// back. Rendering thread.
#pragma once

#include <memory>
#include <vector>

#include "testbed/sensors/session.hpp"
#include "tools/tradeoff/kinds.hpp"

namespace neritic::tools {

class KindBench {
 public:
  struct Measured {
    std::vector<float> image;  // shots, and heads within each, one after the other
    double raster_ms = 0.0, gather_ms = 0.0, receive_ms = 0.0;  // mean over shots
    double ms() const { return raster_ms + gather_ms + receive_ms; }
  };
  // Where each head was, in the order of the image.
  struct Placed {
    Pose world_from_head;
    std::size_t head = 0;
  };

  // kind must outlive it.
  explicit KindBench(const KindSetting& kind) : kind_(kind) {}
  Status open(gpu::Device& device, const scene::Scene& scene);
  // A setting of the kind's sensor; the least time of repeats (0: only images). The scene's own
  // work (bodies that bend) is not counted. draw: added to the scene's seed.
  Result<Measured> render(const scene::Sonar& sonar, int repeats, std::uint64_t draw = 0);
  // The extra time of one setting over another: both are run in turns, so that other load affects
  // both alike; the median of their differences, then the mean over shots.
  struct Price {
    double ms = 0.0;
    double resolution_ms = 0.0;  // its standard error, from the differences' scatter
  };
  Result<Price> price(const scene::Sonar& with, const scene::Sonar& without, int pairs);
  // Sensor poses of the last render.
  const std::vector<Placed>& placed() const { return placed_; }

 private:
  void place(std::size_t index, scene::Sonar sonar, const Shot& shot);

  const KindSetting& kind_;
  std::unique_ptr<testbed::Session> session_;
  std::vector<Placed> placed_;
};

}  // namespace neritic::tools
