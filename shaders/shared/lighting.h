// Light and water as the shading passes see them. Photometric scale: irradiance in lux per colour
// channel (linear sRGB primaries stand for 600, 550 and 450 nm), radiance in lux per steradian.
#ifndef NERITIC_SHARED_LIGHTING_H
#define NERITIC_SHARED_LIGHTING_H
#include "shared/raster.h"

NERITIC_SHARED_BEGIN

NERITIC_CONST uint kLightSun = 1;
NERITIC_CONST uint kLightWater = 2;
NERITIC_CONST uint kLightScattering = 4;
NERITIC_CONST uint kLightSurface = 8;
NERITIC_CONST uint kLightEmissive = 16;  // the G-buffer has an emissive image
// Lamps whose beams are seen in the water: scattering and kGlowReach.
NERITIC_CONST uint kLightGlow = 32;
NERITIC_CONST uint kLightAmbient = 1u << 16;  // the bottom's light
NERITIC_CONST uint kLightSeen = 1u << 17;     // the visibility image: shadows of the sun, occlusion
NERITIC_CONST uint kLightCaustics = 1u << 18;
NERITIC_CONST uint kLightLampShadows = 1u << 19;
// Light that water scatters forwards by small angles is kept: shading writes what it would lose.
NERITIC_CONST uint kLightForwardScatter = 1u << 20;
// The surface has waves. More particles hang near the bed.
NERITIC_CONST uint kLightWaves = 1u << 21;
NERITIC_CONST uint kLightMurk = 1u << 22;
// The sun's light in the water comes through waves and past solids. Some lamp has a profile.
NERITIC_CONST uint kLightShafts = 1u << 23;
NERITIC_CONST uint kLightProfiles = 1u << 24;
// The sun is above the horizon of a scene with the surface: its disc and its glitter.
NERITIC_CONST uint kLightSunSeen = 1u << 25;
// Still things keep the light from above away: the skylight image.
NERITIC_CONST uint kLightSkylight = 1u << 26;
// Some sheet lets diffuse light through: 1 - the albedo image's alpha.
NERITIC_CONST uint kLightThin = 1u << 27;
// Refractive index of sea water against air, in the visible (1.33 to 1.34, Mobley 1994).
NERITIC_CONST float kWaterIndex = 1.333f;
// Diffuse sky light through a flat surface (Mobley 1994, sec. 4.2: reflectance 0.066).
NERITIC_CONST float kSkyTransmittance = 0.934f;
// A sight that passes a lamp at distance d gathers about I b 0.05 m / d of its light. It is seen
// where that exceeds 0.002 of white, so up to this times I b exposure from the lamp.
NERITIC_CONST float kGlowReach = 25.0f;

struct SpotLight {
  vec3 position;  // relative to the origin
  vec3 direction;
  vec3 intensity_cd;
  float cos_inner;
  float cos_outer;
  // With kLightProfiles, where profiled is not 0: intensity over that of the axis, at even steps of
  // sqrt(1 - cosine) from the axis to cos_outer; nothing beyond.
  uint profiled;
  float profile[16];
};
NERITIC_CONST uint kProfileSteps = 16;

struct Lighting {
  uint terms;  // kLight... bits
  uint lamp_count;
  vec3 to_sun;               // unit, in water where there is water
  vec3 surface_irradiance;   // downwelling just under the surface (in air without water), lux
  float direct_share;        // of it that arrives in the sun's beam at the surface
  float origin_depth_m;      // of the view set's origin below y = 0
  vec3 diffuse_attenuation;  // K_d, 1/m
  vec3 beam_attenuation;     // c = a + b, 1/m
  vec3 water_scattering;     // b of pure water, 1/m
  vec3 particle_scattering;  // b of particles, 1/m
  vec3 background;           // radiance where nothing is hit and there is no water
  float emissive_scale;      // lux per steradian of emission 1
  float exposure;            // multiplies radiance before it is stored
  float sun_cosine;          // of the refracted sun to the vertical
  vec3 bottom_color;         // of the bottom: the share of light that it sends back up
  float bottom_depth_m;      // negative: as deep as what it lights
  vec2 caustic_origin_m;     // of the view set's origin in the tile, along x and z
  float caustic_tile_m;
  float murk_bed_m;  // depth of the bed that murk lies on
  float murk_thickness_m;
  float murk_more;  // particles and what they absorb at the bed, over those elsewhere, less 1
  SpotLight lamps[16];
};
NERITIC_CONST uint kMaxLamps = 16;

// Lamps whose light solids stop: their depth maps, a layer each.
NERITIC_CONST uint kMaxLampShadows = 8;
struct LampShadows {
  mat4 clip_from_origin[8];
  float near_m;    // metres from the lamp = near_m / depth
  uint layer[16];  // of a lamp; kMaxLampShadows: it throws none
};

// Bindings of the shade pass.
NERITIC_CONST uint kShadeViews = 0;
NERITIC_CONST uint kShadeLighting = 1;
NERITIC_CONST uint kShadeDepth = 2;
NERITIC_CONST uint kShadeNormal = 3;
NERITIC_CONST uint kShadeAlbedo = 4;
NERITIC_CONST uint kShadeMaterial = 5;
NERITIC_CONST uint kShadeEmissive = 6;
NERITIC_CONST uint kShadeHdr = 7;
NERITIC_CONST uint kShadeSeen = 16;
NERITIC_CONST uint kShadeCaustics = 17;
NERITIC_CONST uint kShadeLampMaps = 18;
NERITIC_CONST uint kShadeLampShadows = 19;
NERITIC_CONST uint kShadeScattered = 24;  // with kLightForwardScatter
NERITIC_CONST uint kShadeWaves = 25;      // with kLightWaves
NERITIC_CONST uint kShadeShafts = 26;     // with kLightShafts
NERITIC_CONST uint kShadeTiles = 27;      // where a list names the tiles
NERITIC_CONST uint kShadeSkylight = 28;   // with kLightSkylight
NERITIC_CONST uint kShadeGroup = 8;
// Specialisation constants of the shade pass: the terms and the number of lamps. Terms that a scene
// does not name are not compiled: a CPU driver computes both sides of a branch, and runs the body
// of a loop at least once.
NERITIC_CONST uint kSpecTerms = 0;
NERITIC_CONST uint kSpecLamps = 1;
NERITIC_CONST uint kSpecSeenStep = 2;     // pixels a side to one of the visibility image
NERITIC_CONST uint kSpecGlowSamples = 3;  // of a lamp's beam along a sight
NERITIC_CONST uint kSpecSeaSeen = 4;      // with kLightSurface: whether these rows can see it
NERITIC_CONST uint kSpecTiled = 6;        // workgroups take their tiles from a list
NERITIC_CONST uint kSpecSurfaces = 7;     // 0: no pixel of these tiles shows a solid
// Push constant of the shade pass: the first row of workgroups, or where its list of tiles begins.
struct ShadePush {
  uint first_group;
  uint first_tile;
};

// The pass that sorts tiles for it. Each list's head has the numbers of an indirect dispatch.
struct ShadeTilesPush {
  uint wide;  // tiles of the picture
  uint high;
  float near_m;
  // How far above the eye the sea's surface is at least. Not above 0: all tiles see it; infinite:
  // none does.
  float sea_off_m;
  float sea_clearest;  // the least attenuation of a beam, 1/m
  vec3 ray_corner;     // as those of View
  vec3 ray_dx;
  vec3 ray_dy;
};
// A list's number.
NERITIC_CONST uint kShadeTileSolid = 1;
NERITIC_CONST uint kShadeTileSea = 2;
NERITIC_CONST uint kShadeTileLists = 4;
NERITIC_CONST uint kShadeTileHead = 4;
NERITIC_CONST uint kShadeTilesDepth = 0;
NERITIC_CONST uint kShadeTilesOut = 1;

// Bindings of the tonemap pass.
NERITIC_CONST uint kTonemapHdr = 0;
NERITIC_CONST uint kTonemapOut = 1;
// Specialisation constant of the tonemap pass: alpha is the luma that antialias compares, else 1.
NERITIC_CONST uint kSpecLumaInAlpha = 0;

// Bindings of the antialias pass.
NERITIC_CONST uint kAntialiasIn = 0;
NERITIC_CONST uint kAntialiasOut = 1;
NERITIC_CONST int kAntialiasBlock = 2;  // pixels a side to an invocation

// Bindings of the average pass, and its specialisation constant: pixels a side that make one.
NERITIC_CONST uint kAverageIn = 0;
NERITIC_CONST uint kAverageOut = 1;
NERITIC_CONST uint kSpecAverageSide = 0;

// Bindings of the resize pass.
NERITIC_CONST uint kResizeIn = 0;
NERITIC_CONST uint kResizeOut = 1;
// Pixels a side that an invocation of it makes, from as many and one more a side of the source.
NERITIC_CONST uint kResizeBlock = 4;

NERITIC_SHARED_END
#endif
