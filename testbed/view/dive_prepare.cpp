// What a view draws unseen before its display's first frame. A pipeline is compiled where it is
// used first, which takes a cold machine seconds, and a headset's wearer would look into the dark
// meanwhile. Rendering thread, once.
#include <cmath>
#include <set>

#include "engine/core/log.hpp"
#include "testbed/view/dive_view.hpp"

namespace neritic::testbed {
namespace {

// Of all views together: what is drawn larger makes no other pipelines.
constexpr double kMostPixels = 2e5;
// Half of a view's width at a distance of 1: wide, so that the pipelines of most that is near are
// needed.
constexpr double kWide = 3.0;
constexpr double kWorthALine_s = 10.0;

}  // namespace

// All rungs that the governor may choose: each level of light has pipelines of its own, and some
// drivers compile for the sizes of textures too.
Status DiveView::prepare() {
  const std::vector<xr::ViewGroup> groups = display_.groups_ahead();
  if (groups.empty()) return {};
  double pixels = 0.0;
  for (const xr::ViewGroup& group : groups)
    pixels +=
        static_cast<double>(group.width) * group.height * static_cast<double>(group.views.size());
  const double most = std::sqrt(kMostPixels / pixels);
  const TimeNs begun = now_ns();
  std::set<std::pair<double, std::uint32_t>> drawn;
  for (const Quality& rung : quality_rungs().first(options_.governed ? kRungs : 1)) {
    const double scale = std::min(rung.view_scale, most);
    if (drawn.emplace(scale, rung.light).second)
      NERITIC_TRY_STATUS(draw_unseen(groups, scale, rung.light));
  }
  const double took_s = 1e-9 * static_cast<double>(now_ns() - begun);
  if (took_s > kWorthALine_s)
    log_warn(
        "the headset's first picture took {:.0f} s, mostly to compile shaders; the next start "
        "finds "
        "them",
        took_s);
  return {};
}

// From the viewpoint, each view of a group in another direction, all around.
Status DiveView::draw_unseen(std::span<const xr::ViewGroup> groups, double scale,
                             std::uint32_t light) {
  FrameRequest request{.time_s = physics_ ? physics_->newest().time_s : 0.0,
                       .sonars = options_.sonars,
                       .capture = kColorOnGpu};
  request.next_time_s = request.time_s;
  if (physics_) request.simulated = &physics_->motion();
  const scene::MotionSource motion(session_.scene(), request.simulated);
  choice_.follow(motion, request.time_s);
  const Pose eyes = choice_.world_from_view();
  const scene::Camera& camera = session_.scene().cameras[choice_.viewpoint().camera];
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const xr::ViewGroup& group = groups[i];
    ViewsRequest views = request_of(i, light);
    views.views.width = scaled(group.width, scale);
    views.views.height = scaled(group.height, scale);
    for (std::size_t k = 0; k < group.views.size(); ++k) {
      const double yaw_rad =
          2.0 * kPi * static_cast<double>(k) / static_cast<double>(group.views.size());
      const Pose pose = eyes * Pose{{}, glm::angleAxis(yaw_rad, Vec3(0.0, 1.0, 0.0))};
      views.views.views.push_back({.world_from_view = pose,
                                   .tangents = {-kWide, kWide, -kWide, kWide},
                                   .near_m = camera.near_m,
                                   .next_world_from_view = pose,
                                   .hidden = group.views[k].hidden});
    }
    request.views.push_back(std::move(views));
  }
  graph::FrameGraph graph;
  NERITIC_TRY(const auto frame, session_.declare(graph, request));
  for (const SensorFrame::Sonar& ping : frame->sonars)
    graph.output(ping.image, graph::Access::kStorageReadCompute);
  for (const SensorFrame::Views& views : frame->views) {
    graph.output(views.color, graph::Access::kSampledFragment);
    if (views.depth) graph.output(views.depth, graph::Access::kTransferRead);
  }
  NERITIC_TRY(gpu::Commands * commands, session_.frames().begin());
  NERITIC_TRY(const graph::Plan* plan, session_.executor().run(graph, *commands));
  (void)plan;
  NERITIC_TRY(const std::uint64_t value, session_.frames().submit({}));
  frame->submitted(value);
  return session_.frames().wait(value);
}

}  // namespace neritic::testbed
