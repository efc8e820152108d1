#include "tools/tradeoff/kind_truth.hpp"

#include <cmath>

namespace neritic::tools {

Result<KindTruth> trace_kind(const RayWorld& world, const Vec3& world_origin_m,
                             std::span<const KindBench::Placed> placed,
                             std::span<const scene::Sonar> sonars, const TruthRays& rays) {
  KindTruth out;
  out.images.resize(sonars.size());
  double off = 0.0, all = 0.0;
  for (const KindBench::Placed& head : placed) {
    TruthView view;
    view.origin_m = head.world_from_head.position_m - world_origin_m;
    view.world_from_head = glm::mat3_cast(head.world_from_head.rotation);
    view.depth_m = -head.world_from_head.position_m.y;
    view.velocity_m_s = kTrackVelocity_m_s;
    view.yaw_rate_rad_s = kTrackYaw_rad_s * view.world_from_head[1].y;
    NERITIC_TRY(const auto truths, trace_terms(world, view, sonars, head.head, rays));
    for (std::size_t i = 0; i < sonars.size(); ++i)
      out.images[i].insert(out.images[i].end(), truths[i].image.begin(), truths[i].image.end());
    for (std::size_t i = 0; i < truths[0].image.size(); ++i) {
      off += std::abs(truths[0].uncertain[i]);
      all += truths[0].image[i];
    }
    out.rays += truths[0].rays;
  }
  out.uncertain = all > 0.0 ? off / all : 0.0;
  return out;
}

}  // namespace neritic::tools
