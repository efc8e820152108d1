#include "engine/render/lighting.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "engine/core/check.hpp"
#include "engine/core/refusal.hpp"
#include "engine/render/water_optics.hpp"
#include "engine/scene/model_lights.hpp"
#include "shared/phase.h"

namespace neritic::render {
namespace {

using shared::kWaterIndex;
// A beam along the horizon gives nothing level, and irradiance / cosine must stay finite: no beam
// comes from lower than 1.1 degrees, the sun's disk twice over.
constexpr double kLeastCosine = 0.02;
// Share of the sky's light of noon that is left when the sun is on the horizon: 300 lux; of a clear
// evening 410 to 585 are said (AMS Glossary of Meteorology, civil twilight).
constexpr double kSkyAtSunset = 0.02;
// Auto exposure opens no further than for this light: what a sensitive video camera still sees in.
// Deeper or darker scenes come out dark.
constexpr double kDarkest_lx = 1.0;
// Weights of linear sRGB in luminance (ITU-R BT.709).
constexpr Vec3 kLuminance{0.2126, 0.7152, 0.0722};

// From air into flat water, unpolarised; sine: of the sun's elevation (Fresnel).
double fresnel_transmittance(double sine) {
  const double in_air = sine;  // cosine of the angle to the vertical
  const double in_water = std::sqrt(1.0 - (1.0 - in_air * in_air) / (kWaterIndex * kWaterIndex));
  const double rs = (in_air - kWaterIndex * in_water) / (in_air + kWaterIndex * in_water);
  const double rp = (kWaterIndex * in_air - in_water) / (kWaterIndex * in_air + in_water);
  return 1.0 - 0.5 * (rs * rs + rp * rp);
}

struct Beam {
  Vec3 to_sun{0.0, 1.0, 0.0};
  double cosine = 1.0;  // to the vertical
};

// level: the level part of the unit vector to the sun in air. Refraction at the flat surface turns
// the sun towards the zenith (Snell).
Beam sun_beam(Vec3 level, bool under_water) {
  if (under_water) level /= kWaterIndex;
  const double cosine =
      std::max(std::sqrt(std::max(0.0, 1.0 - glm::dot(level, level))), kLeastCosine);
  return {glm::normalize(level + Vec3(0.0, cosine, 0.0)), cosine};
}

struct SunLight {
  Beam beam;
  double irradiance_lx = 0.0, direct_share = 0.0;
};

// Light of the sky with the sun below the horizon, over that at sunset. Civil, nautical and
// astronomical twilight end at 6, 12 and 18 degrees with 3.4, 0.008 and 0.0006 lux of some 400 at
// sunset (AMS Glossary of Meteorology; Seidelmann 1992); evenly between in the logarithm.
double twilight(double elevation_rad) {
  constexpr std::array<double, 4> kDecades{0.0, -2.07, -4.70, -5.82};
  const double step = std::min(-elevation_rad / radians(6.0), 3.0);
  const auto i = std::min<std::size_t>(static_cast<std::size_t>(step), 2);
  return std::pow(10.0, std::lerp(kDecades[i], kDecades[i + 1], step - double(i)));
}

// Clouds: of the sum 1 - 0.75 c^3.4 is left, and its diffuse share grows to 1 as c^2 (Kasten and
// Czeplak 1980, Solar Energy 24, 177).
void cover(double share, double& direct, double& sky) {
  const double sum = (direct + sky) * (1.0 - 0.75 * std::pow(share, 3.4));
  const double kept = direct / (direct + sky) * (1.0 - share * share);
  direct = sum * kept;
  sky = sum - direct;
}

SunLight sun_light(const scene::Sun& sun, bool under_water) {
  const double sine = std::sin(sun.elevation_rad);
  double direct = kSunShare * std::max(sine, 0.0);
  double sky = (1.0 - kSunShare) * std::max(std::sqrt(std::max(sine, 0.0)), kSkyAtSunset);
  if (sun.elevation_rad < 0.0) sky *= twilight(sun.elevation_rad);
  if (sun.overcast > 0.0) cover(sun.overcast, direct, sky);
  if (under_water) {
    direct *= fresnel_transmittance(std::max(sine, 0.0));
    sky *= shared::kSkyTransmittance;
  }
  SunLight out;
  out.irradiance_lx = sun.intensity * kClearDay_lx * (direct + sky);
  out.direct_share = direct / (direct + sky);
  out.beam = sun_beam(std::cos(sun.elevation_rad) *
                          Vec3(std::sin(sun.azimuth_rad), 0.0, -std::cos(sun.azimuth_rad)),
                      under_water);
  return out;
}

// Illuminance of a white surface near the camera by the sun, lux.
double sunlight_lx(const shared::Lighting& light) {
  if (!(light.terms & shared::kLightSun)) return 0.0;
  double sum = 0.0;
  const double depth =
      (light.terms & shared::kLightWater) ? std::max(0.0f, light.origin_depth_m) : 0.0;
  for (int i = 0; i < 3; ++i)
    sum += kLuminance[i] * light.surface_irradiance[i] *
           std::exp(-light.diffuse_attenuation[i] * depth);
  return sum;
}

// As beam_of() of shaders/shared/water.glsl.
double beam_share(const shared::SpotLight& spot, double cosine) {
  if (spot.profiled == 0)
    return glm::smoothstep(double(spot.cos_outer), double(spot.cos_inner), cosine);
  const double step =
      std::sqrt(std::max(1.0 - cosine, 0.0) / std::max(1.0 - double(spot.cos_outer), 1e-6)) *
      (shared::kProfileSteps - 1);
  if (!(step <= shared::kProfileSteps - 1)) return 0.0;
  const auto low = std::min(static_cast<std::uint32_t>(step), shared::kProfileSteps - 2);
  return std::lerp(double(spot.profile[low]), double(spot.profile[low + 1]), step - low);
}

// The largest share of its axis's intensity that a lamp sends anywhere: a ring of light has a dark
// axis.
double brightest_share(const shared::SpotLight& spot) {
  return spot.profiled == 0 ? 1.0 : double(*std::ranges::max_element(spot.profile));
}

// The usual distance of a surface from the lamp that lights it, and the least that is counted.
constexpr double kLit_m = 3.0, kTooNear_m = 0.1;

// Illuminance by all lamps of a white surface on the axis of one of them (as if it sent its
// brightest there), square to it and kLit_m away, less what the water takes from its sight to the
// origin; of the brightest of these surfaces, and of that half: most lit ones are farther away or
// oblique.
double lamplight_lx(const shared::Lighting& light) {
  const std::span lamps(light.lamps, light.lamp_count);
  double brightest = 0.0;
  for (const shared::SpotLight& lit : lamps) {
    const Vec3 at = Vec3(lit.position) + kLit_m * Vec3(lit.direction);
    double sum = 0.0;
    for (const shared::SpotLight& spot : lamps) {
      const Vec3 way = at - Vec3(spot.position);
      const double way_m = std::max(glm::length(way), kTooNear_m);
      const double lambert = glm::dot(way, Vec3(lit.direction)) / way_m;
      const double beam = &spot == &lit
                              ? brightest_share(spot)
                              : beam_share(spot, glm::dot(way, Vec3(spot.direction)) / way_m);
      for (int i = 0; lambert > 0.0 && i < 3; ++i)
        sum += kLuminance[i] * spot.intensity_cd[i] * beam * lambert / (way_m * way_m) *
               std::exp(-light.beam_attenuation[i] * (way_m + glm::length(at)));
    }
    brightest = std::max(brightest, sum);
  }
  return 0.5 * brightest;
}

// Lamps count in auto exposure from where they light a surface as the sun does, and alone from
// where they are two stops brighter: then what they light is a light tone, white is not burnt out,
// and the water is as dark as it is.
constexpr double kLampsAlone = 4.0;

// Auto exposure where the water itself shines meters as cameras do, which expose for the water: the
// mean of the logarithms of luminance over a picture of two thirds water and one third ground
// becomes middle grey. A camera sees the ground through water: one that looks level over a bed h
// below, with 60 degrees of view, from 2 h on; without a named bottom 3 m ahead, of this albedo.
constexpr double kMiddleGrey = 0.18, kWaterShare = 2.0 / 3.0, kGround = 0.25, kGroundAhead_m = 3.0;
// No water counts as darker than this, over ground beside the lens: the clearest by daylight has
// 0.045.
constexpr double kLeastWater = 0.04;

// Luminance of the water on a level sight at the origin's depth, the mean of four azimuths: what
// look_through() of shaders/shared/water.glsl adds over an endless length.
double water_luminance(const shared::Lighting& light) {
  constexpr std::uint32_t kNeeded = shared::kLightSun | shared::kLightScattering;
  if ((light.terms & kNeeded) != kNeeded) return 0.0;
  constexpr double kDiffuseCosine = 0.8;  // water.glsl
  const double depth_m = std::max(0.0f, light.origin_depth_m);
  const double height_m = std::max(0.0, light.bottom_depth_m - depth_m);
  double sum = 0.0;
  for (int i = 0; i < 3; ++i) {
    const double particles = light.particle_scattering[i], water = light.water_scattering[i];
    const double down =
        light.surface_irradiance[i] * std::exp(-light.diffuse_attenuation[i] * depth_m);
    const double direct =
        light.direct_share *
        std::exp(-(particles * (1.0 - shared::kParticleG) + water) * depth_m / light.sun_cosine);
    double beam = 0.0;
    for (const float cosine : {light.to_sun.x, -light.to_sun.x, light.to_sun.z, -light.to_sun.z})
      beam += 0.25 * (particles * shared::henyey_greenstein(cosine, shared::kParticleG) +
                      water * shared::sea_water_phase(cosine));
    const double diffuse = particles * shared::henyey_greenstein(0.0f, shared::kDiffuseG) +
                           water * shared::sea_water_phase(0.0f);
    double source = direct * beam / light.sun_cosine + (1.0 - direct) * diffuse / kDiffuseCosine;
    if ((light.terms & shared::kLightAmbient) && light.bottom_depth_m >= 0.0f)
      source += light.bottom_color[i] * std::exp(-2.0 * light.diffuse_attenuation[i] * height_m) *
                0.5 * (particles + water) / kPi;
    sum += kLuminance[i] * down * source / light.beam_attenuation[i];
  }
  return sum;
}

// The metered luminance: the exponential of the mean logarithm over the picture, of which water
// fills kWaterShare and ground the rest. water: the luminance of the water.
double metered_luminance(const shared::Lighting& light, double water, double illuminance_lx) {
  const bool bottom = light.terms & shared::kLightAmbient;
  const bool near = !bottom || light.bottom_depth_m < 0.0f;
  const double away_m = near ? kGroundAhead_m
                             : 2.0 * std::max(0.0, double(light.bottom_depth_m) -
                                                       std::max(0.0f, light.origin_depth_m));
  const double albedo = bottom ? glm::dot(kLuminance, Vec3(light.bottom_color)) : kGround;
  double passed = 0.0;
  for (int i = 0; i < 3; ++i)
    passed += kLuminance[i] * std::exp(-light.beam_attenuation[i] * away_m);
  const double beside = std::max(albedo, 0.05) * illuminance_lx / kPi;
  water = std::max(water, kLeastWater * beside);
  const double ground = beside * passed + water * (1.0 - passed);
  return std::exp(kWaterShare * std::log(water) + (1.0 - kWaterShare) * std::log(ground));
}

// A camera over the surface meters half sky, half sea: the sky at 15 degrees as sky_over() of
// shaders/shared/sea_surface.glsl has it, and the sea seen level from above, which mirrors some
// eighth of that nearby. From the surface up to kAirAt_m this takes the place of the water's own
// metering.
constexpr double kAirAt_m = 0.3, kSkyAt15Degrees = 1.25, kSeaMirrors = 0.12;

double luminance_over_sea(const shared::Lighting& light, double water) {
  const double out = water / (shared::kWaterIndex * shared::kWaterIndex);
  const double sky = kSkyAt15Degrees * (1.0 - light.direct_share) /
                     (kPi * shared::kSkyTransmittance) *
                     glm::dot(kLuminance, Vec3(light.surface_irradiance));
  // Without a sky (a model's sun alone) the water counts.
  return std::sqrt(std::max(sky, out) * (kSeaMirrors * sky + (1.0 - kSeaMirrors) * out));
}

// Auto exposure: what luminance is multiplied by.
double auto_scale(const shared::Lighting& light) {
  const double sunlight = sunlight_lx(light), lamplight = lamplight_lx(light);
  const double water = water_luminance(light);
  if (!(water > 0.0)) return kPi / std::max({sunlight, lamplight, kDarkest_lx});
  double metered = metered_luminance(light, water, std::max(sunlight, kDarkest_lx));
  if (light.terms & shared::kLightSurface) {
    const double in_air = glm::smoothstep(0.0, kAirAt_m, -double(light.origin_depth_m));
    metered = std::pow(metered, 1.0 - in_air) * std::pow(luminance_over_sea(light, water), in_air);
  }
  const double scale = kMiddleGrey / metered, of_lamps = kPi / lamplight;
  if (!(lamplight > sunlight && scale > of_lamps)) return scale;
  const double share = glm::smoothstep(0.0, std::log(kLampsAlone), std::log(lamplight / sunlight));
  return std::pow(scale, 1.0 - share) * std::pow(of_lamps, share);
}

// Beams that reach less than this past their lamp (in daylight, say) are not worth a term.
constexpr float kLeastGlow_m = 1.0f;

bool glows(const shared::Lighting& light) {
  if (!(light.terms & shared::kLightScattering)) return false;
  const Vec3f scattering = light.particle_scattering + light.water_scattering;
  for (std::uint32_t i = 0; i < light.lamp_count; ++i) {
    const Vec3f seen = light.lamps[i].intensity_cd * scattering * light.exposure;
    if (shared::kGlowReach * std::max({seen.x, seen.y, seen.z}) >= kLeastGlow_m) return true;
  }
  return false;
}

// A directional light of a model as the sun: a beam of its lux on what faces it, with no sky. Under
// water it is refracted at the flat surface as the sun is, and nothing of one from below it
// arrives.
void add_model_sun(shared::Lighting& light, const PlacedLight& placed) {
  light.terms |= shared::kLightSun;
  const Vec3 to_light = -placed.direction;
  light.direct_share = 1.0f;
  double irradiance_lx = placed.light->intensity;
  if (light.terms & shared::kLightWater) {
    const Beam beam = sun_beam(Vec3(to_light.x, 0.0, to_light.z), true);
    light.to_sun = Vec3f(beam.to_sun);
    light.sun_cosine = static_cast<float>(beam.cosine);
    const double sine = std::max(to_light.y, 0.0);
    irradiance_lx *= sine * fresnel_transmittance(sine);
  } else {
    // In air only irradiance / cosine counts: a beam may come from anywhere, the horizon included.
    light.to_sun = Vec3f(to_light);
    light.sun_cosine = 1.0f;
  }
  light.surface_irradiance = placed.light->color * static_cast<float>(irradiance_lx);
}

// The share of an exposure, round its middle, in which a strobe burns: it flashes at the start of
// each period.
double burning_share(const scene::Lamp& lamp, double time_s, double exposed_s) {
  if (lamp.strobe_period_s <= 0.0) return 1.0;
  const double period_s = lamp.strobe_period_s;
  const auto since_s = [&](double s) { return s - std::floor(s / period_s) * period_s; };
  if (exposed_s <= 0.0) return since_s(time_s) < lamp.strobe_flash_s ? 1.0 : 0.0;
  // How long it has burnt since the period's start in which the exposure begins.
  const double flash_s = std::min(lamp.strobe_flash_s, period_s);
  const auto burnt_s = [&](double s) {
    return std::floor(s / period_s) * flash_s + std::min(since_s(s), flash_s);
  };
  const double begin_s = since_s(time_s - 0.5 * exposed_s);
  return std::clamp((burnt_s(begin_s + exposed_s) - burnt_s(begin_s)) / exposed_s, 0.0, 1.0);
}

void add_lamp(shared::Lighting& light, const scene::Lamp& lamp, const Pose& pose,
              const Vec3& origin_m) {
  shared::SpotLight& spot = light.lamps[light.lamp_count++];
  spot.position = Vec3f(pose.position_m - origin_m);
  spot.direction = Vec3f(pose.rotation * Vec3(0, 0, -1));
  spot.intensity_cd = lamp.color * static_cast<float>(lamp.intensity_cd);
  if (lamp.profile) {
    static_assert(scene::LampProfile::kSteps == shared::kProfileSteps);
    light.terms |= shared::kLightProfiles;
    spot.profiled = 1;
    std::ranges::copy(lamp.profile->share, spot.profile);
  }
  spot.cos_inner = static_cast<float>(std::cos(lamp.inner_cone_rad));
  spot.cos_outer =
      static_cast<float>(std::cos(std::max(lamp.outer_cone_rad, lamp.inner_cone_rad + 1e-3)));
  if (lamp.profile) spot.cos_outer = static_cast<float>(std::cos(lamp.outer_cone_rad));
}

// Further away a lamp of 1e9 cd, the brightest that is read, gives a thousandth of a lux.
constexpr double kFurthestLamp_m = 1e6;

// A point light is a lamp whose cone is the whole sphere: all cosines are above both ends of the
// cone's edge.
void add_model_lamp(shared::Lighting& light, const PlacedLight& placed, const Vec3& origin_m) {
  const Vec3 from_origin_m = placed.position_m - origin_m;
  if (!(glm::length(from_origin_m) < kFurthestLamp_m)) return;
  const bool point = placed.light->kind == scene::Light::Kind::kPoint;
  const double inner = placed.light->inner_cone_rad, outer = placed.light->outer_cone_rad;
  shared::SpotLight& spot = light.lamps[light.lamp_count++];
  spot.position = Vec3f(from_origin_m);
  spot.direction = Vec3f(placed.direction);
  spot.intensity_cd = placed.light->color * placed.light->intensity;
  spot.cos_inner = point ? -2.0f : static_cast<float>(std::cos(inner));
  spot.cos_outer = point ? -3.0f : static_cast<float>(std::cos(std::max(outer, inner + 1e-3)));
}

}  // namespace

static_assert(scene::kMaxLamps == shared::kMaxLamps);

Vec3 to_sun_in_air(const scene::Sun& sun) {
  const double level = std::cos(sun.elevation_rad);
  return {level * std::sin(sun.azimuth_rad), std::sin(sun.elevation_rad),
          -level * std::cos(sun.azimuth_rad)};
}

Result<shared::Lighting> make_lighting(const scene::Scene& scene, const FrameState& state,
                                       const Vec3& origin_m, const scene::Exposure& exposure,
                                       bool has_emission, double exposed_s) {
  shared::Lighting light{};
  light.origin_depth_m = static_cast<float>(-origin_m.y);
  light.sun_cosine = 1.0f;
  if (has_emission) light.terms |= shared::kLightEmissive;
  if (scene.water) {
    NERITIC_TRY(const WaterOptics optics, jerlov_optics(scene.water->type));
    light.terms |= shared::kLightWater;
    if (scene.water->scattering) light.terms |= shared::kLightScattering;
    if (scene.water->surface) light.terms |= shared::kLightSurface;
    if (scene.water->forward_scatter) light.terms |= shared::kLightForwardScatter;
    if (scene.water->waves) light.terms |= shared::kLightWaves;
    if (scene.water->murk && scene.water->murk->factor > 1.0) {
      light.terms |= shared::kLightMurk;
      light.murk_bed_m = static_cast<float>(scene.water->murk->bed_depth_m);
      light.murk_thickness_m = static_cast<float>(scene.water->murk->thickness_m);
      light.murk_more = static_cast<float>(scene.water->murk->factor - 1.0);
    }
    light.diffuse_attenuation = Vec3f(optics.diffuse_attenuation_m);
    light.beam_attenuation = Vec3f(optics.beam_attenuation_m());
    light.water_scattering = Vec3f(optics.water_scattering_m);
    light.particle_scattering = Vec3f(optics.particle_scattering_m);
  }
  if (scene.sun) {
    const SunLight sun = sun_light(*scene.sun, scene.water.has_value());
    light.terms |= shared::kLightSun;
    light.to_sun = Vec3f(sun.beam.to_sun);
    light.surface_irradiance = Vec3f(static_cast<float>(sun.irradiance_lx));
    light.direct_share = static_cast<float>(sun.direct_share);
    light.sun_cosine = static_cast<float>(sun.beam.cosine);
  }
  if (scene.ambient) {
    light.terms |= shared::kLightAmbient;
    light.bottom_color = scene.ambient->bottom_color;
    light.bottom_depth_m = static_cast<float>(scene.ambient->bottom_depth_m.value_or(-1.0));
  }
  if (scene.lamps.size() > shared::kMaxLamps)
    return refusal(fmt::format("{}: lamps", scene.path), fmt::format("{}", scene.lamps.size()),
                   fmt::format("at most {}", shared::kMaxLamps));
  NERITIC_CHECK(state.world_from_lamp.size() == scene.lamps.size(), "{} poses of {} lamps",
                state.world_from_lamp.size(), scene.lamps.size());
  for (std::size_t i = 0; i < scene.lamps.size(); ++i)
    add_lamp(light, scene.lamps[i], state.world_from_lamp[i], origin_m);
  for (const PlacedLight& placed : state.lights)
    if (placed.light->kind == scene::Light::Kind::kDirectional)
      add_model_sun(light, placed);
    else if (light.lamp_count < shared::kMaxLamps)
      add_model_lamp(light, placed, origin_m);
  if ((light.terms & shared::kLightSurface) &&
      glm::dot(light.surface_irradiance, Vec3f(light.direct_share)) > 0.0f)
    light.terms |= shared::kLightSunSeen;
  double scale = auto_scale(light);
  if (exposure.fixed_ev) scale = std::exp2(-*exposure.fixed_ev);
  light.exposure = static_cast<float>(scale * std::exp2(exposure.compensation_ev));
  for (std::size_t i = 0; i < scene.lamps.size(); ++i)
    light.lamps[i].intensity_cd *=
        static_cast<float>(burning_share(scene.lamps[i], state.time_s, exposed_s));
  if (glows(light)) light.terms |= shared::kLightGlow;
  light.emissive_scale = 1.0f / light.exposure;
  light.background = Vec3f(0.06f, 0.075f, 0.10f) / light.exposure;
  return light;
}

std::string names_of_terms(const shared::Lighting& lighting) {
  constexpr std::pair<std::uint32_t, const char*> kNames[] = {
      {shared::kLightSun, "sun"},
      {shared::kLightWater, "water"},
      {shared::kLightScattering, "scattering"},
      {shared::kLightSurface, "surface"},
      {shared::kLightEmissive, "emission"},
      {shared::kLightGlow, "glow of lamps"},
      {shared::kLightAmbient, "ambient"},
      {shared::kLightSeen, "visibility"},
      {shared::kLightCaustics, "caustics"},
      {shared::kLightLampShadows, "shadows of lamps"},
      {shared::kLightForwardScatter, "forward scatter"},
      {shared::kLightWaves, "waves"},
      {shared::kLightMurk, "murk"},
      {shared::kLightShafts, "light shafts"},
      {shared::kLightProfiles, "beam profiles"},
      {shared::kLightSunSeen, "the sun's image"},
      {shared::kLightSkylight, "skylight"},
      {shared::kLightThin, "light through sheets"}};
  std::vector<std::string> names;
  for (const auto& [bit, name] : kNames)
    if (lighting.terms & bit) names.emplace_back(name);
  if (lighting.lamp_count > 0)
    names.push_back(
        fmt::format("{} lamp{}", lighting.lamp_count, lighting.lamp_count == 1 ? "" : "s"));
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace neritic::render
