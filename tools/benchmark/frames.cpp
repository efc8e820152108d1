// Whole frames through Session: the sonar's scene of 23 000 triangles, the default scene's picture,
// a hundred instances, ten sonars.
#include <cmath>
#include <span>

#include "engine/core/clock.hpp"
#include "engine/render/draw_list.hpp"
#include "tools/benchmark/groups.hpp"

namespace neritic::bench {
namespace {

using testbed::FrameRequest;
using testbed::FrameResult;
using testbed::Session;

FrameRequest request_of(std::vector<std::size_t> cameras, std::vector<std::size_t> sonars,
                        bool color, bool geometry, bool motion) {
  FrameRequest request;
  request.cameras = std::move(cameras);
  request.sonars = std::move(sonars);
  request.capture.color = color;
  request.capture.motion = motion;
  if (!geometry) request.capture = request.capture.without_geometry();
  return request;
}

double mean_difference(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b) {
  if (a.size() != b.size() || a.empty()) return 255.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::abs(int{a[i]} - int{b[i]});
  return sum / static_cast<double>(a.size());
}

Facts scene_facts(const std::string& file, const Session& session) {
  return {{"scene", file}, {"triangles", static_cast<double>(session.gpu_scene().triangles())}};
}

// The cost of a frame on the CPU before anything is recorded.
Contender cpu_costs(const std::string& name, Session& session) {
  return {name, [&session]() -> Result<Sample> {
            const TimeNs start = now_ns();
            const render::FrameState state = render::evaluate_frame(
                session.scene(), session.gpu_scene(), 0.0, 1.0 / 30.0, false);
            const TimeNs evaluated = now_ns();
            const render::DrawList draws = render::build_draw_list(
                session.scene(), session.gpu_scene(), state,
                testbed::camera_views(session.scene(), session.scene().cameras[0]));
            const TimeNs listed = now_ns();
            return Sample{
                to_ms(listed - start),
                {{"evaluate", to_ms(evaluated - start)}, {"draw list", to_ms(listed - evaluated)}},
                fmt::format("{} of {} triangles", draws.triangles, draws.all_triangles)};
          }};
}

}  // namespace

Status bench_sonar_frame(Suite& suite, gpu::Device& device) {
  if (!suite.wants("sonar_frame")) return {};
  const std::string file = "benchmark_23k.toml";
  NERITIC_TRY(const auto one, open_scene(suite, device, file));
  if (one->scene().sonars.empty()) return bad_input("{}: it has no sonar", file);
  const scene::Sonar& sonar = one->scene().sonars[0];
  NERITIC_TRY(const auto ten, open_scene(suite, device, file, [&](scene::Scene& scene) {
                for (std::size_t i = 1; i < 10; ++i) {
                  scene.sonars.push_back(sonar);
                  scene.sonars.back().name += fmt::format("_{}", i);
                }
              }));
  FrameRequest all = request_of({}, {0}, false, false, false);
  for (std::size_t i = 1; i < 10; ++i) all.sonars.push_back(i);
  const FrameRequest image = request_of({}, {0}, false, false, false);
  const FrameRequest arrays = request_of({}, {0}, false, true, false);
  Contender single = frames_of("sonar_frame/23k", *one, image);
  Contender with_arrays = frames_of("sonar_frame/23k_with_gbuffer_arrays", *one, arrays);
  Contender many = frames_of("sonar_frame/23k_ten_sonars", *ten, all);
  for (Contender* c : {&single, &with_arrays, &many}) {
    c->facts = scene_facts(file, *one);
    c->facts["bins"] = std::vector<double>{static_cast<double>(sonar.bins_range),
                                           static_cast<double>(sonar.bins_azimuth),
                                           static_cast<double>(sonar.bins_elevation)};
  }
  NERITIC_TRY_STATUS(suite.measure({single, with_arrays, many}, 40));

  // The same sonar image however much else is asked for.
  NERITIC_TRY(const auto a, one->render(image));
  NERITIC_TRY(const auto b, one->render(arrays));
  NERITIC_TRY(const auto c, ten->render(all));
  const std::string expected = hash_of(a.sonars[0].image);
  if (hash_of(b.sonars[0].image) != expected)
    suite.fail("the sonar image differs when the G-buffer is read back too");
  for (const testbed::SonarFrame& frame : c.sonars)
    if (hash_of(frame.image) != expected)
      suite.fail("one of ten equal sonars gives another image: " + frame.name);
  suite.ratio("ten_sonars_vs_one", "sonar_frame/23k_ten_sonars", "sonar_frame/23k");
  const Measured* once = suite.find("sonar_frame/23k");
  const Measured* tenfold = suite.find("sonar_frame/23k_ten_sonars");
  if (once != nullptr && tenfold != nullptr)
    suite.aim_most("ten sonars in one frame", "times one", tenfold->min_ms() / once->min_ms(),
                   10.0);
  suite.aim_ms("sonar frame, 23 000 triangles", "sonar_frame/23k", 10.0);
  return {};
}

Status bench_camera_frame(Suite& suite, gpu::Device& device) {
  if (!suite.wants("camera_frame")) return {};
  const auto resize = [](scene::Scene& scene) {
    scene.cameras.at(0).width = 1280;
    scene.cameras.at(0).height = 720;
  };
  NERITIC_TRY(const auto wreck, open_scene(suite, device, "wreck.toml", resize));
  NERITIC_TRY(const auto pool, open_scene(suite, device, "pool.toml", resize));
  NERITIC_TRY(const auto instances, open_scene(suite, device, "instances.toml", resize));
  const FrameRequest color = request_of({0}, {}, true, false, false);
  const FrameRequest everything = request_of({0}, {}, true, true, true);
  const auto contender = [&](const std::string& name, const std::string& file, Session& session,
                             const FrameRequest& request) {
    Contender c = frames_of("camera_frame/" + name, session, request);
    c.facts = scene_facts(file, session);
    c.facts["size"] = std::vector<double>{1280, 720};
    return c;
  };
  NERITIC_TRY_STATUS(
      suite.measure({contender("wreck_720p", "wreck.toml", *wreck, color),
                     contender("wreck_720p_all_arrays", "wreck.toml", *wreck, everything),
                     contender("pool_720p", "pool.toml", *pool, color),
                     contender("instances_720p", "instances.toml", *instances, color),
                     cpu_costs("camera_frame/wreck_cpu", *wreck),
                     cpu_costs("camera_frame/instances_cpu", *instances)}));
  NERITIC_TRY(const auto alone, wreck->render(color));
  NERITIC_TRY(const auto arrays, wreck->render(request_of({0}, {}, true, true, false)));
  NERITIC_TRY(const auto all, wreck->render(everything));
  const auto picture = [](const FrameResult& frame) -> const auto& {
    return frame.cameras[0].eyes[0].color.data;
  };
  if (picture(arrays) != picture(all))
    suite.fail("the wreck's picture beside arrays differs when motion is asked for too");
  // Without arrays far meshes are coarser (DECISIONS 55).
  constexpr double kMost_levels = 1.0;
  const double levels = mean_difference(picture(alone), picture(all));
  if (!(levels < kMost_levels))
    suite.fail(fmt::format("coarser meshes change the wreck's picture by {:.2f} levels", levels));
  return {};
}

}  // namespace neritic::bench
