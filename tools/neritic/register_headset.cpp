#include "tools/neritic/register_headset.hpp"

#include <deque>

#include "engine/gpu/device.hpp"
#include "engine/xr/openxr/headset.hpp"
#include "tools/neritic/interrupt.hpp"

namespace neritic::tools {
namespace {

// Held by hand at a mark: a hand trembles by some millimetres.
constexpr double kStill_m = 0.008, kStill_s = 1.5, kApart_m = 0.2;

// Where the headset has been of late, and whether it is still.
class Stillness {
 public:
  // The mean place once it was still for long enough, far enough from the last such place.
  std::optional<Vec3> add(TimeNs at_ns, const Vec3& place_m) {
    if (!places_.empty() && at_ns <= places_.back().at_ns) return {};
    places_.push_back({at_ns, place_m});
    Vec3 least = place_m, most = place_m, sum(0.0);
    std::size_t first = places_.size();
    while (first > 0) {
      const Vec3& earlier = places_[first - 1].at_m;
      least = glm::min(least, earlier), most = glm::max(most, earlier);
      if (glm::length(most - least) > kStill_m) break;
      sum += earlier;
      --first;
    }
    places_.erase(places_.begin(), places_.begin() + static_cast<std::ptrdiff_t>(first));
    if (1e-9 * static_cast<double>(at_ns - places_.front().at_ns) < kStill_s) return {};
    const Vec3 mean = sum / static_cast<double>(places_.size());
    if (last_ && glm::distance(*last_, mean) < kApart_m) return {};
    last_ = mean;
    places_.clear();
    return mean;
  }

 private:
  struct Place {
    TimeNs at_ns = 0;
    Vec3 at_m{0.0};
  };
  std::deque<Place> places_;
  std::optional<Vec3> last_;
};

}  // namespace

Status measure_by_headset(std::vector<PointPair>& pairs) {
  const Interrupt interrupt;
  std::unique_ptr<gpu::Device> device;  // outlives the headset
  NERITIC_TRY(const auto headset, xr::Headset::connect({.room = true}));
  gpu::DeviceOptions options;
  headset->require(options);
  NERITIC_TRY(device, gpu::Device::create(options));
  NERITIC_TRY_STATUS(headset->attach(*device));
  Stillness stillness;
  for (std::size_t i = 0; i < pairs.size();) {
    const Vec3& to = pairs[i].to_m;
    fmt::print(stderr,
               "hold the headset still at place {} of {}: {:.3f} {:.3f} {:.3f} of the scene\n",
               i + 1, pairs.size(), to.x, to.y, to.z);
    std::optional<Vec3> place;
    while (!place) {
      if (interrupt.requested())
        return failure(ErrorCode::kInterrupted, "interrupted at place {} of {}", i + 1,
                       pairs.size());
      NERITIC_TRY(const xr::DisplayFrame frame, headset->begin_frame({}));
      if (frame.verdict == xr::FrameVerdict::kQuit)
        return failure(ErrorCode::kUnsupported, "the runtime ended at place {} of {}", i + 1,
                       pairs.size());
      if (frame.world_from_head && frame.display_at_ns)
        place = stillness.add(*frame.display_at_ns, frame.world_from_head->position_m);
      NERITIC_TRY_STATUS(headset->end_frame(false));
    }
    pairs[i++].from_m = *place;
  }
  return {};
}

}  // namespace neritic::tools
