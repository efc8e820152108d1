#include "engine/render/lighting.hpp"

#include <algorithm>
#include <cmath>

#include "engine/render/water_optics.hpp"

namespace neritic::render {
namespace {

constexpr double kWaterIndex = 1.333;
// Diffuse sky light through a flat surface (Mobley 1994, sec. 4.2: reflectance .066).
constexpr double kSkyTransmittance = 0.934;
// Auto exposure opens no further than for this light: what a sensitive video camera still sees in.
// Deeper or darker scenes come out dark.
constexpr double kDarkest_lx = 1.0;
// Weights of linear sRGB in luminance (ITU-R BT.709).
constexpr Vec3 kLuminance{0.2126, 0.7152, 0.0722};

struct SunLight {
  Vec3 to_sun{0.0, 1.0, 0.0};
  double irradiance_lx = 0.0, direct_share = 0.0, cosine = 1.0;
};

// From air into flat water, unpolarised; sine: of the sun's elevation (Fresnel).
double fresnel_transmittance(double sine) {
  const double in_air = sine;  // cosine of the angle to the vertical
  const double in_water = std::sqrt(1.0 - (1.0 - in_air * in_air) / (kWaterIndex * kWaterIndex));
  const double rs = (in_air - kWaterIndex * in_water) / (in_air + kWaterIndex * in_water);
  const double rp = (kWaterIndex * in_air - in_water) / (kWaterIndex * in_air + in_water);
  return 1.0 - 0.5 * (rs * rs + rp * rp);
}

SunLight sun_light(const scene::Sun& sun, bool under_water) {
  const double sine = std::sin(sun.elevation_rad);
  double direct = kSunShare * std::max(sine, 0.0);
  // The sky keeps some light when the sun is low.
  double sky = (1.0 - kSunShare) * std::max(std::sqrt(std::max(sine, 0.0)), 0.02);
  if (under_water) {
    direct *= fresnel_transmittance(std::max(sine, 0.0));
    sky *= kSkyTransmittance;
  }
  SunLight out;
  out.irradiance_lx = sun.intensity * kClearDay_lx * (direct + sky);
  out.direct_share = direct / (direct + sky);
  // Refraction at the flat surface turns the sun towards the zenith (Snell).
  const double in_air = std::cos(sun.elevation_rad);
  const double horizontal = under_water ? in_air / kWaterIndex : in_air;
  out.cosine = std::max(std::sqrt(std::max(0.0, 1.0 - horizontal * horizontal)), 0.02);
  out.to_sun = glm::normalize(Vec3(std::sin(sun.azimuth_rad) * horizontal, out.cosine,
                                   -std::cos(sun.azimuth_rad) * horizontal));
  return out;
}

// What a white surface near the camera receives, lux: the sun's light there, or half of the
// strongest lamp's at 3 m (most of what it lights is further or oblique), and no less than
// kDarkest_lx.
double scene_illuminance_lx(const shared::Lighting& light, const scene::Scene& scene) {
  double sum = 0.0;
  if (light.terms & shared::kLightSun) {
    const double depth =
        (light.terms & shared::kLightWater) ? std::max(0.0f, light.origin_depth_m) : 0.0;
    for (int i = 0; i < 3; ++i)
      sum += kLuminance[i] * light.surface_irradiance[i] *
             std::exp(-light.diffuse_attenuation[i] * depth);
  }
  double lamps = 0.0;
  for (const scene::Lamp& lamp : scene.lamps) lamps = std::max(lamps, lamp.intensity_cd / 9.0);
  return std::max({sum, lamps * 0.5, kDarkest_lx});
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

}  // namespace

Result<shared::Lighting> make_lighting(const scene::Scene& scene, const Vec3& origin_m,
                                       const scene::Exposure& exposure, bool has_emission,
                                       double time_s) {
  shared::Lighting light{};
  light.origin_depth_m = static_cast<float>(-origin_m.y);
  light.sun_cosine = 1.0f;
  if (has_emission) light.terms |= shared::kLightEmissive;
  if (scene.water) {
    NERITIC_TRY(const WaterOptics optics, jerlov_optics(scene.water->type));
    light.terms |= shared::kLightWater;
    if (scene.water->scattering) light.terms |= shared::kLightScattering;
    if (scene.water->surface) light.terms |= shared::kLightSurface;
    light.diffuse_attenuation = Vec3f(optics.diffuse_attenuation_m);
    light.beam_attenuation = Vec3f(optics.beam_attenuation_m());
    light.water_scattering = Vec3f(optics.water_scattering_m);
    light.particle_scattering = Vec3f(optics.particle_scattering_m);
  }
  if (scene.sun) {
    const SunLight sun = sun_light(*scene.sun, scene.water.has_value());
    light.terms |= shared::kLightSun;
    light.to_sun = Vec3f(sun.to_sun);
    light.surface_irradiance = Vec3f(static_cast<float>(sun.irradiance_lx));
    light.direct_share = static_cast<float>(sun.direct_share);
    light.sun_cosine = static_cast<float>(sun.cosine);
  }
  if (scene.lamps.size() > shared::kMaxLamps)
    return bad_input("{}: {} lamps, at most {} are accepted", scene.path, scene.lamps.size(),
                     shared::kMaxLamps);
  for (const scene::Lamp& lamp : scene.lamps) {
    const Pose pose = scene.world_from(lamp.mount, time_s);
    shared::SpotLight& spot = light.lamps[light.lamp_count++];
    spot.position = Vec3f(pose.position_m - origin_m);
    spot.direction = Vec3f(pose.rotation * Vec3(0, 0, -1));
    spot.intensity_cd = lamp.color * static_cast<float>(lamp.intensity_cd);
    spot.cos_inner = static_cast<float>(std::cos(lamp.inner_cone_rad));
    spot.cos_outer =
        static_cast<float>(std::cos(std::max(lamp.outer_cone_rad, lamp.inner_cone_rad + 1e-3)));
  }
  const double illuminance = scene_illuminance_lx(light, scene);
  double scale = kPi / illuminance;
  if (exposure.fixed_ev) scale = std::exp2(-*exposure.fixed_ev);
  light.exposure = static_cast<float>(scale * std::exp2(exposure.compensation_ev));
  if (glows(light)) light.terms |= shared::kLightGlow;
  light.emissive_scale = 1.0f / light.exposure;
  light.background = Vec3f(0.06f, 0.075f, 0.10f) / light.exposure;
  return light;
}

}  // namespace neritic::render
