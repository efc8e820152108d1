// The price of each term of light and water in a picture: the default scene with everything named,
// and without one term, in turns; its levels of detail. Times are those of the device's passes.
#include <functional>
#include <utility>

#include "tools/benchmark/groups.hpp"

namespace neritic::bench {
namespace {

using testbed::FrameRequest;
using testbed::Session;

// All that a diver would see there and a scene can name.
void name_everything(scene::Scene& scene) {
  scene.cameras.at(0).width = 1280;
  scene.cameras.at(0).height = 720;
  if (!scene.sun->shadows) scene.sun->shadows = scene::SunShadows{.cascades = 2};
  if (!scene.sun->caustics) scene.sun->caustics = scene::Caustics{};
  if (!scene.sun->shafts) scene.sun->shafts = scene::Shafts{};
  if (!scene.ambient) scene.ambient = scene::Ambient{.bottom_depth_m = 18.0, .occlusion_m = 1.5};
  scene::Water& water = *scene.water;
  if (!water.forward_scatter) water.forward_scatter = scene::ForwardScatter{};
  if (!water.snow) water.snow = scene::Snow{};
  if (!water.waves) water.waves = SeaState{};
  if (!water.murk) water.murk = scene::Murk{.bed_depth_m = 18.0};
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    if (scene.objects[i].name == "diver" && water.bubbles.empty()) {
      water.bubbles.emplace_back().object = static_cast<int>(i);
    }
    if (scene.objects[i].name == "rov" && water.silt.empty()) {
      scene::SiltSource& silt = water.silt.emplace_back();
      silt.object = static_cast<int>(i);
      silt.bed_depth_m = 18.0;
      silt.reach_m = 4.0;
    }
  }
}

struct Term {
  const char* name;
  std::function<void(scene::Scene&)> leave_out;
};

std::vector<Term> terms() {
  return {
      {"sun_shadows", [](scene::Scene& s) { s.sun->shadows.reset(); }},
      {"occlusion", [](scene::Scene& s) { s.ambient->occlusion_m = 0.0; }},
      {"caustics", [](scene::Scene& s) { s.sun->caustics.reset(); }},
      {"shafts", [](scene::Scene& s) { s.sun->shafts.reset(); }},
      {"forward_scatter", [](scene::Scene& s) { s.water->forward_scatter.reset(); }},
      {"snow", [](scene::Scene& s) { s.water->snow.reset(); }},
      {"waves", [](scene::Scene& s) { s.water->waves.reset(); }},
      {"murk", [](scene::Scene& s) { s.water->murk.reset(); }},
      {"bubbles", [](scene::Scene& s) { s.water->bubbles.clear(); }},
      {"silt", [](scene::Scene& s) { s.water->silt.clear(); }},
      {"antialias", [](scene::Scene& s) { s.cameras[0].antialias = false; }},
  };
}

Contender passes_of(const std::string& name, Session& session) {
  FrameRequest request;
  request.cameras = {0};
  request.time_s = 20.0;
  request.next_time_s = 20.0 + 1.0 / 30.0;
  request.capture = testbed::Capture{.motion = false}.without_geometry();
  return {.name = "picture_terms/" + name,
          .run = [&session, request]() -> Result<Sample> {
            NERITIC_TRY(const testbed::FrameResult result, session.render(request));
            Sample sample{0.0, parts_of(result.passes), hash_of(result)};
            for (const auto& [pass, ms] : sample.parts)
              if (pass != "record" && pass.find("readback") == std::string::npos) sample.ms += ms;
            return sample;
          },
          .facts = {{"size", std::vector<double>{1280, 720}}},
          .warm = true};
}

// A group's result by its name, where the filter names one.
bool wants_result(const Suite& suite, const std::string& name) {
  const std::string& filter = suite.options().filter;
  return filter.find('/') == std::string::npos ||
         ("picture_terms/" + name).find(filter) != std::string::npos;
}

Status price_terms(Suite& suite, gpu::Device& device, const std::string& file, Session& all) {
  for (const Term& term : terms()) {
    const std::string name = term.name;
    if (!wants_result(suite, "with_" + name) && !wants_result(suite, "without_" + name)) continue;
    NERITIC_TRY(const auto without, open_scene(suite, device, file, [&](scene::Scene& scene) {
                  name_everything(scene);
                  term.leave_out(scene);
                }));
    NERITIC_TRY_STATUS(
        suite.measure({passes_of("with_" + name, all), passes_of("without_" + name, *without)}, 8));
    const Measured* with = suite.find("picture_terms/with_" + name);
    const Measured* bare = suite.find("picture_terms/without_" + name);
    if (with && bare) suite.note("price_of_" + name + "_ms", with->min_ms() - bare->min_ms());
  }
  return {};
}

// A school in the default scene as a scene file has it: whole frames, since the processor places
// the fish.
Status price_fish(Suite& suite, gpu::Device& device) {
  if (!wants_result(suite, "fish_10000") && !wants_result(suite, "fish_none")) return {};
  NERITIC_TRY(const auto none, open_scene(suite, device, "wreck.toml"));
  NERITIC_TRY(const auto school, open_scene(suite, device, "../benchmarks/school.toml"));
  FrameRequest request;
  request.cameras = {0};
  request.time_s = 20.0;
  request.next_time_s = 20.0 + 1.0 / 30.0;
  request.capture = testbed::Capture{.motion = false}.without_geometry();
  NERITIC_TRY_STATUS(suite.measure({frames_of("picture_terms/fish_10000", *school, request),
                                    frames_of("picture_terms/fish_none", *none, request)},
                                   12));
  const Measured* with = suite.find("picture_terms/fish_10000");
  const Measured* bare = suite.find("picture_terms/fish_none");
  if (with && bare) suite.aim_most("10 000 fish", "ms more", with->min_ms() - bare->min_ms(), 20.0);
  return {};
}

}  // namespace

Status bench_picture_terms(Suite& suite, gpu::Device& device) {
  if (!suite.wants("picture_terms")) return {};
  const std::string file = "wreck.toml";
  std::unique_ptr<Session> all;
  if (wants_result(suite, "everything") ||
      suite.options().filter.find("/with") != std::string::npos) {
    NERITIC_TRY(all, open_scene(suite, device, file, name_everything));
    NERITIC_TRY_STATUS(price_terms(suite, device, file, *all));
  }
  if (wants_result(suite, "everything") || wants_result(suite, "everything_draft")) {
    NERITIC_TRY(const auto draft, open_scene(suite, device, file, [](scene::Scene& scene) {
                  name_everything(scene);
                  scene.cameras[0].detail = scene::picture_level("draft").detail;
                }));
    std::vector<Contender> levels{passes_of("everything_draft", *draft)};
    if (all) levels.push_back(passes_of("everything", *all));
    NERITIC_TRY_STATUS(suite.measure(std::move(levels), 12));
  }
  if (wants_result(suite, "lit_23k")) {
    NERITIC_TRY(const auto small, open_scene(suite, device, "../benchmarks/lit_23k.toml"));
    Contender picture = passes_of("lit_23k", *small);
    picture.facts["size"] = std::vector<double>{640, 480};
    NERITIC_TRY_STATUS(suite.measure({picture}, 12));
  }
  NERITIC_TRY_STATUS(price_fish(suite, device));
  suite.aim_ms("default scene with everything named", "picture_terms/everything", 250.0);
  suite.aim_ms("the same at draft", "picture_terms/everything_draft", 60.0);
  suite.aim_ms("640x480 of 23 000 triangles with sun, two lamps, inscatter and snow",
               "picture_terms/lit_23k", 60.0);
  return {};
}

}  // namespace neritic::bench
