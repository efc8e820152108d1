// `light`, read once from the uniform block that the including file declares as light_data: main() begins with
// take_light() (shared/even.glsl tells why). Beam profiles stay in the block. The number of lamps must be a constant
// of the pipeline, so that loops over them are unrolled. GLSL only.
#ifndef NERITIC_EVEN_LIGHT_GLSL
#define NERITIC_EVEN_LIGHT_GLSL
#include "shared/lighting.h"
#define NERITIC_LAMP_PROFILE(i, k) (light_data.lamps[i].profile[k])
#define NERITIC_OVER_LAMPS [[unroll]] for (uint i = 0u; i < lamp_count(); ++i)

Lighting light;

void take_light() {
  light.terms = light_data.terms;
  light.lamp_count = light_data.lamp_count;
  light.to_sun = light_data.to_sun;
  light.surface_irradiance = light_data.surface_irradiance;
  light.direct_share = light_data.direct_share;
  light.origin_depth_m = light_data.origin_depth_m;
  light.diffuse_attenuation = light_data.diffuse_attenuation;
  light.beam_attenuation = light_data.beam_attenuation;
  light.water_scattering = light_data.water_scattering;
  light.particle_scattering = light_data.particle_scattering;
  light.background = light_data.background;
  light.emissive_scale = light_data.emissive_scale;
  light.exposure = light_data.exposure;
  light.sun_cosine = light_data.sun_cosine;
  light.bottom_color = light_data.bottom_color;
  light.bottom_depth_m = light_data.bottom_depth_m;
  light.caustic_origin_m = light_data.caustic_origin_m;
  light.caustic_tile_m = light_data.caustic_tile_m;
  light.murk_bed_m = light_data.murk_bed_m;
  light.murk_thickness_m = light_data.murk_thickness_m;
  light.murk_more = light_data.murk_more;
  NERITIC_OVER_LAMPS {
    light.lamps[i].position = light_data.lamps[i].position;
    light.lamps[i].direction = light_data.lamps[i].direction;
    light.lamps[i].intensity_cd = light_data.lamps[i].intensity_cd;
    light.lamps[i].cos_inner = light_data.lamps[i].cos_inner;
    light.lamps[i].cos_outer = light_data.lamps[i].cos_outer;
    light.lamps[i].profiled = light_data.lamps[i].profiled;
  }
}

#endif
