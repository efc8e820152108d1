#include "tools/tradeoff/bands_error.hpp"

#include <algorithm>

#include "testbed/sensors/session.hpp"
#include "tools/tradeoff/spectrum_error.hpp"

namespace neritic::tools {
namespace {

constexpr const char* kCardWaters[] = {"I", "III", "5C"};
constexpr double kCardDepths_m[] = {1.0, 5.0, 10.0, 20.0};

// Largest error of a white card from 1 to 20 m.
Result<double> bands_error(std::uint32_t bands) {
  double worst = 0.0;
  for (const char* water : kCardWaters)
    for (double depth_m = 1.0; depth_m <= 20.0; depth_m += 1.0) {
      NERITIC_TRY(const double error, card_error(water, depth_m, bands));
      worst = std::max(worst, error);
    }
  return worst;
}

// A picture of open water, all its passes.
Result<double> bands_ms(gpu::Device& device, std::uint32_t bands, bool quick) {
  scene::Scene scene;
  scene.path = "optics";
  scene.sun = scene::Sun{};
  scene.water = scene::Water{.type = "II", .scattering = true};
  scene::Camera camera;
  camera.name = "eye";
  camera.width = quick ? 64 : 640;
  camera.height = quick ? 36 : 360;
  camera.mount.pose.position_m = Vec3(0.0, -5.0, 0.0);
  if (bands > 3) camera.terms.spectrum = scene::Spectrum{.bands = bands};
  scene.cameras.push_back(camera);
  NERITIC_TRY(const auto session, testbed::Session::create(device, std::move(scene)));
  double least_ms = 1e300;
  for (int i = 0; i < 4; ++i) {
    testbed::FrameRequest request;
    request.cameras = {0};
    request.capture = testbed::Capture{.motion = false}.without_geometry();
    NERITIC_TRY(const testbed::FrameResult result, session->render(request));
    double ms = 0.0;
    for (const gpu::PassTime& pass : result.passes)
      if (pass.name.starts_with("eye ") && pass.name.find("readback") == std::string::npos)
        ms += pass.ms;
    least_ms = std::min(least_ms, ms);
  }
  return least_ms * 1e6 / (double(camera.width) * camera.height);
}

}  // namespace

Result<OpticsPoint> bands_point(gpu::Device& device, std::uint32_t bands, bool quick) {
  NERITIC_TRY(const double error, bands_error(bands));
  NERITIC_TRY(const double ms, bands_ms(device, bands, quick));
  return OpticsPoint{"bands", bands, error, ms};
}

Result<std::string> card_table() {
  std::string out =
      "\nA white card's CIEDE2000 against every nanometre:\n\n| type, depth m | 3 bands | 9 | 12 | "
      "15 |\n|---|---|---|---|---|\n";
  for (const char* water : kCardWaters)
    for (const double depth_m : kCardDepths_m) {
      out += fmt::format("| {}, {} |", water, depth_m);
      for (const std::uint32_t bands : kBandCounts) {
        NERITIC_TRY(const double error, card_error(water, depth_m, bands));
        out += fmt::format(" {:.2f} |", error);
      }
      out += "\n";
    }
  return out;
}

}  // namespace neritic::tools
