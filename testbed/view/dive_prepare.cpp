// A pipeline is compiled where it is used first, which takes a cold machine seconds, and a
// headset's wearer would look into the dark meanwhile: so a view draws unseen before. Rendering
// thread, once.
#include "testbed/view/dive_prepare.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <set>
#include <tuple>

#include "engine/core/log.hpp"
#include "engine/gpu/pipeline_work.hpp"
#include "testbed/view/dive_view.hpp"

namespace neritic::testbed {
namespace {

// Of all views together: what is drawn larger makes no other pipelines.
constexpr double kMostPixels = 2e4;
// Half of a view's width at a distance of 1: wide, so that the pipelines of most that is near are
// needed.
constexpr double kWide = 3.0;

// By bits: whether so many pixels, and what passes make of them at a half to a sixteenth, are
// powers of two.
std::uint32_t powers_of_two(std::uint32_t pixels) {
  std::uint32_t bits = 0;
  for (std::uint32_t k = 0; k <= 4; ++k) {
    const std::uint32_t part = (pixels + (1u << k) - 1) >> k;
    bits |= (std::has_single_bit(part) ? 1u : 0u) << k;
  }
  return bits;
}

// The fewest pixels, from `least` on, whose powers of two are those of `real`.
std::uint32_t alike(std::uint32_t least, std::uint32_t real) {
  std::uint32_t pixels = least;
  while (pixels < real && powers_of_two(pixels) != powers_of_two(real)) ++pixels;
  return std::min(pixels, real);
}

}  // namespace

// The view's resolution changes no pipeline, the light does. Mesa's software driver compiles its
// shaders also for whether a texture's width and height are powers of two.
std::vector<UnseenPicture> unseen_pictures(std::span<const xr::ViewGroup> groups,
                                           std::span<const Quality> rungs) {
  double pixels = 0.0;
  for (const xr::ViewGroup& group : groups)
    pixels +=
        static_cast<double>(group.width) * group.height * static_cast<double>(group.views.size());
  const double small = std::min(1.0, std::sqrt(kMostPixels / pixels));
  std::vector<UnseenPicture> out;
  std::set<std::vector<std::uint32_t>> drawn;  // lights and powers of two that a picture has
  for (const Quality& rung : rungs) {
    UnseenPicture picture{.light = rung.light};
    std::vector<std::uint32_t> kind{rung.light};
    const auto side = [&](std::uint32_t full) {
      const std::uint32_t real = scaled(full, rung.view_scale);
      kind.push_back(powers_of_two(real));
      return alike(scaled(full, small), real);
    };
    for (const xr::ViewGroup& group : groups) {
      const std::uint32_t width = side(group.width);
      picture.sizes.emplace_back(width, side(group.height));
    }
    if (drawn.insert(std::move(kind)).second) out.push_back(std::move(picture));
  }
  return out;
}

// What pictures take longer than the same ones again is compiling, but for calls that make
// pipelines: some drivers' take as long whenever a program starts.
std::string prepare_note(const PrepareTimes& times) {
  constexpr double kMostly = 0.67;
  const double compiled_s = times.took_s - times.again_s - (times.cache_grew ? 0.0 : times.made_s);
  if (times.took_s <= kWorthALine_s || compiled_s < kMostly * times.took_s) return {};
  return fmt::format(
      "the headset's first picture took {:.0f} s, mostly to compile shaders; the next start finds "
      "them",
      times.took_s);
}

Status DiveView::prepare() {
  const std::vector<xr::ViewGroup> groups = display_.groups_ahead();
  if (groups.empty()) return {};
  const auto pictures =
      unseen_pictures(groups, quality_rungs().first(options_.governed ? kRungs : 1));
  // Sonars in the first alone: no rung changes their pipelines.
  const auto draw_all = [&](double& took_s) -> Status {
    const TimeNs begun = now_ns();
    for (std::size_t i = 0; i < pictures.size(); ++i)
      NERITIC_TRY_STATUS(draw_unseen(groups, pictures[i], i == 0));
    took_s = 1e-9 * static_cast<double>(now_ns() - begun);
    return {};
  };
  PrepareTimes times;
  const gpu::PipelineWork before = gpu::pipeline_work(session_.device());
  NERITIC_TRY_STATUS(draw_all(times.took_s));
  if (times.took_s <= kWorthALine_s) return {};
  const gpu::PipelineWork after = gpu::pipeline_work(session_.device());
  times.made_s = after.seconds - before.seconds;
  times.cache_grew = after.cache_bytes > before.cache_bytes;
  NERITIC_TRY_STATUS(draw_all(times.again_s));
  if (const std::string note = prepare_note(times); !note.empty()) log_warn("{}", note);
  return {};
}

// From the viewpoint, each view of a group in another direction, all around.
Status DiveView::draw_unseen(std::span<const xr::ViewGroup> groups, const UnseenPicture& picture,
                             bool sonars) {
  FrameRequest request{.time_s = physics_ ? physics_->newest().time_s : 0.0,
                       .capture = kColorOnGpu};
  if (sonars) request.sonars = options_.sonars;
  request.next_time_s = request.time_s;
  if (physics_) request.simulated = &physics_->motion();
  const scene::MotionSource motion(session_.scene(), request.simulated);
  choice_.follow(motion, request.time_s);
  const Pose eyes = choice_.world_from_view();
  const scene::Camera& camera = session_.scene().cameras[choice_.viewpoint().camera];
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const xr::ViewGroup& group = groups[i];
    ViewsRequest views = request_of(i, picture.light);
    std::tie(views.views.width, views.views.height) = picture.sizes[i];
    views.each_particle = true;
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
