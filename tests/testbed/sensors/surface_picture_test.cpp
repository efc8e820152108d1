// The water's surface in pictures, from below, from above and at it, against closed forms: Snell's
// law and Fresnel's equations, the sun's disc of 0.53 degrees, and its glitter, whose light is what
// a level surface mirrors, however rough it is (Cox and Munk 1954).
#include <gtest/gtest.h>

#include <cmath>

#include "engine/render/lighting.hpp"
#include "engine/render/water_optics.hpp"
#include "engine/scene/shapes.hpp"
#include "testbed/sensors/session.hpp"
#include "tests/support/gpu_fixture.hpp"

namespace neritic::testbed {
namespace {

using SurfacePicture = test::GpuTest;

constexpr double kSeaIndex = 1.333;

// A camera at a height over the surface, with the sun ahead of it (azimuth 0) unless it is turned.
struct SurfaceLook {
  double height_m = 0.5, pitch_rad = 0.0, sun_rad = radians(40.0), sun_azimuth_rad = kPi;
  double fov_rad = radians(4.0), ev = 15.0;
  std::uint32_t side = 17;
  bool scattering = false;
  std::optional<double> wind_m_s;
  std::optional<double> bottom_depth_m;
};

const Vec3f kBottomColor(0.4f, 0.5f, 0.6f);

scene::Scene surface_scene(const SurfaceLook& look) {
  scene::Scene scene;
  scene.path = "test";
  scene.sun = scene::Sun{.elevation_rad = look.sun_rad, .azimuth_rad = look.sun_azimuth_rad};
  scene.water = scene::Water{.type = "IB", .scattering = look.scattering, .surface = true};
  if (look.wind_m_s) scene.water->waves = SeaState{.wind_m_s = *look.wind_m_s};
  if (look.bottom_depth_m)
    scene.ambient =
        scene::Ambient{.bottom_color = kBottomColor, .bottom_depth_m = *look.bottom_depth_m};
  scene::Camera camera;
  camera.name = "eye";
  camera.width = camera.height = look.side;
  camera.vertical_fov_rad = look.fov_rad;
  camera.terms.linear = true;
  camera.exposure.fixed_ev = look.ev;
  camera.mount.pose = {Vec3(0.0, look.height_m, 0.0),
                       glm::angleAxis(look.pitch_rad, Vec3(1.0, 0.0, 0.0))};
  scene.cameras.push_back(camera);
  return scene;
}

// Radiance of every pixel, lx/sr.
struct SurfaceRadiances {
  std::uint32_t side = 0;
  std::vector<Vec3> values;
  const Vec3& at(std::uint32_t x, std::uint32_t y) const { return values[y * side + x]; }
  Vec3 middle() const { return at(side / 2, side / 2); }
};

Result<SurfaceRadiances> surface_radiances(gpu::Device& device, const SurfaceLook& look) {
  NERITIC_TRY(const auto session, Session::create(device, surface_scene(look)));
  FrameRequest request;
  request.cameras = {0};
  NERITIC_TRY(const FrameResult result, session->render(request));
  const ImageF32& linear = result.cameras[0].eyes[0].linear;
  SurfaceRadiances out{look.side, std::vector<Vec3>(std::size_t{look.side} * look.side)};
  for (std::size_t i = 0; i < out.values.size(); ++i)
    for (int ch = 0; ch < 3; ++ch) {
      const float value = linear.data[3 * i + static_cast<std::size_t>(ch)];
      EXPECT_TRUE(std::isfinite(value) && value >= 0.0f) << i;
      out.values[i][ch] = value * std::exp2(look.ev);
    }
  return out;
}

// Sum over the picture of f(radiance, cosine to the vertical, solid angle).
template <class F>
double sum_over(const SurfaceRadiances& map, const SurfaceLook& look, F&& f) {
  const double reach = std::tan(0.5 * look.fov_rad), pixel = 2.0 * reach / look.side;
  const Quat turned = glm::angleAxis(look.pitch_rad, Vec3(1.0, 0.0, 0.0));
  double sum = 0.0;
  for (std::uint32_t y = 0; y < look.side; ++y)
    for (std::uint32_t x = 0; x < look.side; ++x) {
      const Vec3 ray((x + 0.5) * pixel - reach, reach - (y + 0.5) * pixel, -1.0);
      const double cosine = 1.0 / glm::length(ray);
      sum += f(map.at(x, y), (turned * (ray * cosine)).y, pixel * pixel * std::pow(cosine, 3.0));
    }
  return sum;
}

double surface_fresnel(double cos_in_air) {
  const double sine = std::sqrt(1.0 - cos_in_air * cos_in_air) / kSeaIndex;
  const double in_water = std::sqrt(1.0 - sine * sine);
  const double rs = (cos_in_air - kSeaIndex * in_water) / (cos_in_air + kSeaIndex * in_water);
  const double rp = (in_water - kSeaIndex * cos_in_air) / (in_water + kSeaIndex * cos_in_air);
  return 0.5 * (rs * rs + rp * rp);
}

Result<shared::Lighting> lighting_of(gpu::Device& device, const SurfaceLook& look) {
  const scene::Scene scene = surface_scene(look);
  NERITIC_TRY(const auto session, Session::create(device, scene));
  const render::FrameState state =
      render::evaluate_frame(scene, session->gpu_scene(), 0.0, 0.1, false);
  return render::make_lighting(scene, state, Vec3(0.0), {}, false);
}

// Illuminance of the sun's beam in air on what faces it, lux: what has passed the surface, over
// Fresnel's share of it.
Result<Vec3> beam_lx(gpu::Device& device, const SurfaceLook& look) {
  NERITIC_TRY(const shared::Lighting light, lighting_of(device, look));
  const double sine = std::sin(look.sun_rad);
  return Vec3(light.surface_irradiance) * double(light.direct_share) /
         ((1.0 - surface_fresnel(sine)) * sine);
}

TEST_F(SurfacePicture, FlatWaterShowsTheSkyWithinSnellsWindowAndMirrorsTheDeepOutside) {
  NERITIC_ASSERT_OK(const render::WaterOptics optics, render::jerlov_optics("IB"));
  for (const double zenith_deg : {5.0, 30.0, 45.0, 48.0, 49.2, 60.0, 80.0}) {
    const double zenith = radians(zenith_deg), sine_air = kSeaIndex * std::sin(zenith);
    NERITIC_ASSERT_OK(
        const SurfaceRadiances seen,
        surface_radiances(device(),
                          {.height_m = -0.3, .pitch_rad = 0.5 * kPi - zenith, .fov_rad = 1e-3}));
    if (sine_air >= 1.0) {
      EXPECT_EQ(glm::length(seen.middle()), 0.0) << zenith_deg;  // the deep does not scatter
      continue;
    }
    const double cos_air = std::sqrt(1.0 - sine_air * sine_air);
    NERITIC_ASSERT_OK(
        const SurfaceRadiances sky,
        surface_radiances(device(), {.pitch_rad = std::asin(cos_air), .fov_rad = 1e-3}));
    for (int ch = 0; ch < 3; ++ch) {
      const double wanted = kSeaIndex * kSeaIndex * (1.0 - surface_fresnel(cos_air)) *
                            std::exp(-optics.beam_attenuation_m()[ch] * 0.3 / std::cos(zenith));
      EXPECT_NEAR(seen.middle()[ch] / sky.middle()[ch] / wanted, 1.0, 0.02) << zenith_deg;
    }
  }
}

// In water that does not scatter the mirrored bottom is light that comes down by K_d, leaves it
// evenly, and comes back by c along the sight's way up to the surface and down to the eye.
TEST_F(SurfacePicture, OutsideSnellsWindowFlatWaterMirrorsTheNamedBottom) {
  NERITIC_ASSERT_OK(const render::WaterOptics optics, render::jerlov_optics("IB"));
  for (const double bottom_m : {3.0, 6.0})
    for (const double zenith_deg : {52.0, 65.0, 75.0}) {
      const double zenith = radians(zenith_deg);
      SurfaceLook look{.height_m = -0.3,
                       .pitch_rad = 0.5 * kPi - zenith,
                       .fov_rad = 1e-3,
                       .ev = 10.0,
                       .bottom_depth_m = bottom_m};
      NERITIC_ASSERT_OK(const SurfaceRadiances seen, surface_radiances(device(), look));
      NERITIC_ASSERT_OK(const shared::Lighting light, lighting_of(device(), look));
      for (int ch = 0; ch < 3; ++ch) {
        const double sight_m = (bottom_m + 0.3) / std::cos(zenith);
        const double wanted = double(light.surface_irradiance[ch]) * kBottomColor[ch] / kPi *
                              std::exp(-optics.diffuse_attenuation_m[ch] * bottom_m -
                                       optics.beam_attenuation_m()[ch] * sight_m);
        EXPECT_NEAR(seen.middle()[ch] / wanted, 1.0, 0.02) << zenith_deg << " " << bottom_m;
      }
    }
}

TEST_F(SurfacePicture, FlatWaterMirrorsTheSkyAboveByFresnel) {
  for (const double down_deg : {88.0, 60.0, 30.0, 10.0, 3.0}) {
    const double down = radians(down_deg);
    NERITIC_ASSERT_OK(const SurfaceRadiances water,
                      surface_radiances(device(), {.pitch_rad = -down, .fov_rad = 1e-3}));
    NERITIC_ASSERT_OK(const SurfaceRadiances sky,
                      surface_radiances(device(), {.pitch_rad = down, .fov_rad = 1e-3}));
    EXPECT_NEAR(water.middle().y / sky.middle().y / surface_fresnel(std::sin(down)), 1.0, 0.02)
        << down_deg;
  }
}

// Half of the picture is the air's and half the water's, as of cameras just over and under it.
TEST_F(SurfacePicture, ACameraAtTheSurfaceSeesAirAboveTheLineAndWaterBelow) {
  SurfaceLook look{.height_m = 0.0, .fov_rad = radians(70.0), .side = 32, .scattering = true};
  NERITIC_ASSERT_OK(const SurfaceRadiances at, surface_radiances(device(), look));
  look.height_m = 3.0;
  NERITIC_ASSERT_OK(const SurfaceRadiances over, surface_radiances(device(), look));
  look.height_m = -1.0;
  NERITIC_ASSERT_OK(const SurfaceRadiances under, surface_radiances(device(), look));
  for (std::uint32_t y = 0; y < look.side; ++y)
    for (std::uint32_t x = 0; x < look.side; ++x) {
      const Vec3& wanted = y < look.side / 2 ? over.at(x, y) : under.at(x, y);
      // Under water light fades by the way between the two depths.
      EXPECT_NEAR(at.at(x, y).y / wanted.y, 1.0, y < look.side / 2 ? 1e-3 : 0.15) << x << " " << y;
    }
}

TEST_F(SurfacePicture, TheLineOnTheWindowRisesAsTheCameraSinks) {
  std::uint32_t last = 0;
  for (const double height_m : {0.02, 0.0, -0.02}) {
    NERITIC_ASSERT_OK(
        const SurfaceRadiances at,
        surface_radiances(
            device(),
            {.height_m = height_m, .fov_rad = radians(70.0), .side = 32, .scattering = true}));
    std::uint32_t dark = 0;  // water is darker than the sky and its mirror image
    for (std::uint32_t y = 0; y < 32; ++y)
      if (at.at(16, y).x < 0.3 * at.at(16, 0).x) ++dark;
    EXPECT_GT(dark, last) << height_m;
    last = dark;
  }
}

TEST_F(SurfacePicture, TheSunsDiscIsAsWideAndAsBrightAsTheSun) {
  SurfaceLook look{.pitch_rad = radians(40.0),
                   .sun_azimuth_rad = 0.0,
                   .fov_rad = radians(0.8),
                   .ev = 20.0,
                   .side = 81};
  NERITIC_ASSERT_OK(const Vec3 beam, beam_lx(device(), look));
  NERITIC_ASSERT_OK(const SurfaceRadiances seen, surface_radiances(device(), look));
  const double peak = seen.middle().y;
  const auto of_sun = [&](const Vec3& radiance, double, double sr) {
    return radiance.y > 1e6 ? radiance.y * sr : 0.0;
  };
  EXPECT_NEAR(sum_over(seen, look, of_sun) / beam.y, 1.0, 0.01);
  const double disc_sr = sum_over(seen, look, [&](const Vec3& radiance, double, double sr) {
    return radiance.y > 0.5 * peak ? sr : 0.0;
  });
  EXPECT_NEAR(degrees(2.0 * std::sqrt(disc_sr / kPi)), 0.533, 0.005);
}

// Wherever the sun lies between the pixels of a coarse picture, it gives nearly as much light.
TEST_F(SurfacePicture, ASunSmallerThanAPixelDoesNotFlicker) {
  for (const double off_deg : {0.0, 0.4, 0.8, 1.2}) {
    SurfaceLook look{.pitch_rad = radians(40.0 + off_deg),
                     .sun_azimuth_rad = 0.0,
                     .fov_rad = radians(60.0),
                     .ev = 20.0,
                     .side = 41};
    NERITIC_ASSERT_OK(const Vec3 beam, beam_lx(device(), look));
    NERITIC_ASSERT_OK(const SurfaceRadiances seen, surface_radiances(device(), look));
    const double sum = sum_over(seen, look, [](const Vec3& radiance, double, double sr) {
      return radiance.y > 1e5 ? radiance.y * sr : 0.0;
    });
    EXPECT_NEAR(sum / beam.y, 1.0, 0.25) << off_deg;
  }
}

// From above: the glitter's light on a level plane is Fresnel's share of the sun's, whether its
// facets are calm water's, unresolved or waves.
TEST_F(SurfacePicture, TheGlitterIsTheLightThatALevelSurfaceMirrors) {
  struct Case {
    std::optional<double> wind_m_s;
    double height_m, limit;
  };
  for (const Case& sea : {Case{{}, 2.0, 0.08}, Case{6.0, 400.0, 0.11}, Case{6.0, 4.0, 0.25}}) {
    SurfaceLook look{.height_m = sea.height_m,
                     .pitch_rad = -0.5 * kPi,
                     .sun_rad = radians(75.0),
                     .sun_azimuth_rad = 0.0,
                     .fov_rad = radians(100.0),
                     .ev = 17.0,
                     .side = 160,
                     .wind_m_s = sea.wind_m_s};
    NERITIC_ASSERT_OK(const Vec3 beam, beam_lx(device(), look));
    NERITIC_ASSERT_OK(const SurfaceRadiances with, surface_radiances(device(), look));
    const auto level = [](const Vec3& radiance, double down, double sr) {
      return radiance.y * -down * sr;
    };
    const auto sky = [&](const Vec3&, double down, double sr) { return -down * sr; };
    // The mirrored sky, whose share is small, counts as even.
    double least = 1e30;
    for (const Vec3& value : with.values) least = std::min(least, value.y);
    const double sky_light = least * sum_over(with, look, sky);
    const double glitter = sum_over(with, look, level) - sky_light;
    const double wanted = surface_fresnel(std::sin(look.sun_rad)) * beam.y * std::sin(look.sun_rad);
    EXPECT_NEAR(glitter / wanted, 1.0, sea.limit) << sea.height_m;
  }
}

// One view is shaded by tiles, of which some see the sea and some a solid; the layers of two views
// are not. Of solids before, in and behind the surface, from below and above it, both show the
// same.
TEST_F(SurfacePicture, TilesShowWhatAWholePictureShows) {
  for (const bool waves : {false, true})
    for (const double height_m : {-6.0, -0.4, 1.5}) {
      if (!waves && height_m > -1.0) continue;
      scene::Scene scene = surface_scene({.height_m = height_m,
                                          .scattering = true,
                                          .wind_m_s = waves ? std::optional(5.0) : std::nullopt});
      scene.models.push_back(std::make_shared<scene::Model>(scene::make_box(Vec3(2.0))));
      for (const Vec3& at : {Vec3(-2.0, -4.0, -5.0), Vec3(1.0, 0.0, -7.0), Vec3(3.0, -9.0, -9.0)}) {
        scene::Object box;
        box.model = 0;
        box.mount.pose.position_m = at;
        scene.objects.push_back(box);
      }
      NERITIC_ASSERT_OK(const auto session, Session::create(device(), scene));
      render::ViewSet views = camera_views(session->scene(), session->scene().cameras.front());
      views.width = 160;
      views.height = 120;
      views.views.front().tangents = {-1.0, 1.0, -0.75, 0.75};
      const auto shown = [&](std::size_t eyes) {
        render::ViewSet set = views;
        set.views.resize(eyes, views.views.front());
        FrameRequest request;
        request.views.push_back({.name = "view",
                                 .views = set,
                                 .exposure = session->scene().cameras.front().exposure,
                                 .capture = Capture{.motion = false}.without_geometry()});
        return std::move(session->render(request).value().views[0].eyes[0].color);
      };
      EXPECT_EQ(shown(1).data, shown(2).data) << height_m;
    }
}

TEST_F(SurfacePicture, SunAtTheZenithOnTheHorizonAndBelowGivesFinitePictures) {
  for (const double sun_deg : {90.0, 0.5, 0.0, -10.0, -90.0}) {
    // Halves hold the light of noon and of night at different exposures.
    const double ev = sun_deg > 0.0 ? 15.0 : sun_deg < 0.0 ? -5.0 : 10.0;
    NERITIC_ASSERT_OK(
        const SurfaceRadiances sky,
        surface_radiances(
            device(),
            {.pitch_rad = 0.5 * kPi, .sun_rad = radians(sun_deg), .ev = ev, .scattering = true}));
    for (const double height_m : {0.5, 0.0, -0.5})
      for (const double pitch_deg : {-30.0, 0.0, 30.0})
        for (const bool waves : {false, true}) {
          const SurfaceLook look{.height_m = height_m,
                                 .pitch_rad = radians(pitch_deg),
                                 .sun_rad = radians(sun_deg),
                                 .sun_azimuth_rad = 0.0,
                                 .fov_rad = radians(80.0),
                                 .ev = ev,
                                 .side = 24,
                                 .scattering = true,
                                 .wind_m_s = waves ? std::optional(6.0) : std::nullopt};
          NERITIC_ASSERT_OK(const SurfaceRadiances seen, surface_radiances(device(), look));
          double brightest = 0.0;
          for (const Vec3& value : seen.values) brightest = std::max(brightest, value.y);
          EXPECT_GT(brightest, 0.0) << sun_deg << " " << height_m << " " << pitch_deg;
          // A sky without a sun is 1.75 times as bright at the horizon as overhead; water gathers
          // it n^2 times.
          if (sun_deg <= 0.0) {
            EXPECT_LT(brightest, 3.3 * sky.middle().y)
                << sun_deg << " " << height_m << " " << pitch_deg;
          }
        }
  }
}

}  // namespace
}  // namespace neritic::testbed
