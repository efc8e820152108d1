// Pictures in bands of the spectrum: what a camera reads of a white card under water against the
// sum over the whole spectrum, surfaces' colours in air, and what a scene pays that names none.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/render/bands.hpp"
#include "engine/scene/shapes.hpp"
#include "testbed/sensors/session.hpp"
#include "tests/support/gpu_fixture.hpp"

namespace neritic::testbed {
namespace {

using SpectrumGpu = test::GpuTest;

// A plate of this colour half a metre below a camera, which is depth_m deep.
scene::Scene plate(const Vec3f& color, double depth_m, const char* water, std::uint32_t bands) {
  scene::Scene scene;
  scene.path = "test";
  scene.sun = scene::Sun{.elevation_rad = radians(50.0), .azimuth_rad = kPi};
  if (water) scene.water = scene::Water{.type = water};
  scene::Camera camera;
  camera.name = "eye";
  camera.width = camera.height = 9;
  camera.exposure.fixed_ev = 14.0;
  camera.mount.pose = {Vec3(0.0, -depth_m, 0.0), glm::angleAxis(-0.5 * kPi, Vec3(1.0, 0.0, 0.0))};
  camera.terms.linear = true;
  if (bands > 0) camera.terms.spectrum = scene::Spectrum{.bands = bands};
  scene.cameras.push_back(camera);
  scene::Model box = scene::make_box({20.0, 1.0, 20.0});
  scene::Material paint;
  paint.metallic = 0.0f;
  paint.base_color = Vec4f(color, 1.0f);
  box.materials = {paint};
  for (scene::Primitive& primitive : box.meshes[0].primitives) primitive.material = 0;
  scene.models.push_back(std::make_shared<scene::Model>(std::move(box)));
  scene::Object object;
  object.name = "plate";
  object.model = 0;
  object.class_id = object.instance = 1;
  object.mount.pose.position_m = Vec3(0.0, -depth_m - 1.0, 0.0);
  scene.objects.push_back(object);
  return scene;
}

struct Read {
  Vec3 linear{0.0};
  std::vector<std::string> passes;
};
Read read(gpu::Device& device, scene::Scene scene) {
  Read out;
  const auto session = Session::create(device, std::move(scene));
  EXPECT_TRUE(session.ok());
  FrameRequest request;
  request.cameras = {0};
  const auto result = (*session)->render(request);
  EXPECT_TRUE(result.ok()) << result.error().message;
  if (!result.ok()) return out;
  for (int i = 0; i < 3; ++i) out.linear[i] = result->cameras[0].eyes[0].linear.at(4, 4, i);
  for (const gpu::PassTime& pass : result->passes) out.passes.push_back(pass.name);
  return out;
}

// Every nanometre: daylight, the eye, and what K_d and c leave on the way down and to the camera.
Vec3 whole_spectrum(const char* water, double depth_m, double sight_m) {
  Vec3 sum(0.0), white(0.0);
  for (double nm = 400.5; nm < 700.0; nm += 1.0) {
    const render::WaveBand here{nm, nm};
    const auto optics = render::jerlov_optics(water, {here, here, here});
    const Vec3 response = render::response_to_daylight({}, nm);
    white += response;
    sum += response * std::exp(-depth_m * optics->diffuse_attenuation_m.x -
                               sight_m * optics->beam_attenuation_m().x);
  }
  return sum / white;
}

TEST_F(SpectrumGpu, AWhiteCardUnderWaterIsThatOfTheWholeSpectrum) {
  const Vec3 near = read(device(), plate(Vec3f(0.8f), 0.01, "IB", 12)).linear;
  for (const double depth_m : {4.0, 15.0}) {
    const Vec3 seen = read(device(), plate(Vec3f(0.8f), depth_m, "IB", 12)).linear,
               three = read(device(), plate(Vec3f(0.8f), depth_m, "IB", 0)).linear;
    const Vec3 wanted = whole_spectrum("IB", depth_m + 0.5, 0.5) / whole_spectrum("IB", 0.51, 0.5);
    for (int i = 0; i < 3; ++i)
      EXPECT_NEAR(seen[i] / near[i], wanted[i], 0.015) << depth_m << " m, channel " << i;
    // The red of three bands, at 600 nm, fades far less: what the bands are for.
    EXPECT_GT(three.x / near.x, wanted.x + 0.1) << depth_m;
  }
}

TEST_F(SpectrumGpu, SurfacesKeepTheirColoursInAir) {
  const Vec3f colour(0.45f, 0.30f, 0.20f);
  const Vec3 three = read(device(), plate(colour, -10.0, nullptr, 0)).linear;
  for (const std::uint32_t bands : {9u, 15u}) {
    const Vec3 seen = read(device(), plate(colour, -10.0, nullptr, bands)).linear;
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(seen[i] / three[i], 1.0, 0.02) << bands << " " << i;
  }
}

TEST_F(SpectrumGpu, NoBandIsDeclaredForACameraThatNamesNone) {
  const auto holds = [](const Read& seen, const char* name) {
    return std::ranges::any_of(
        seen.passes, [&](const std::string& pass) { return pass.find(name) != std::string::npos; });
  };
  const Read without = read(device(), plate(Vec3f(0.5f), 2.0, "II", 0)),
             with = read(device(), plate(Vec3f(0.5f), 2.0, "II", 9));
  for (const char* name : {"bands", "band albedo"}) {
    EXPECT_FALSE(holds(without, name)) << name;
    EXPECT_TRUE(holds(with, name)) << name;
  }
  EXPECT_FALSE(holds(with, "shimmer"));
}

}  // namespace
}  // namespace neritic::testbed
