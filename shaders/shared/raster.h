// Shared by the passes that rasterise: views, instances, materials, vertex streams, bindings.
// All positions on the GPU are metres relative to the view set's origin (the first camera's place),
// in world axes, so a scene 100 km away loses nothing.
#ifndef NERITIC_SHARED_RASTER_H
#define NERITIC_SHARED_RASTER_H
#include "shared/types.h"

NERITIC_SHARED_BEGIN

NERITIC_CONST uint kMaxViews = 6;  // of one multiview set (Vulkan guarantees six)

struct View {
  mat4 clip_from_origin;
  mat4 next_clip_from_origin;  // at the next frame's time, from the same origin
  vec3 eye;                    // relative to the origin
  float near_m;                // planar metres = near_m / depth
  // Direction of the pixel (x, y), view z = -1, in world axes: corner + x * dx + y * dy.
  vec3 ray_corner;
  vec3 ray_dx;
  vec3 ray_dy;
  vec4 within;  // seen is where its dot with (position from the origin, 1) is not negative
};

// One instance, as a vertex stream that steps once an instance: a processor's driver fetches
// vertices in bulk, but reads a storage buffer lane by lane. Rows of the affine origin_from_object:
// p' = (dot(row0, p1), ...), p1 = (p, 1).
struct Instance {
  vec4 row0;
  vec4 row1;
  vec4 row2;
  uint label;     // class | instance << 16
  uint deformed;  // first vertex in the deformed stream, or ~0: the mesh's own vertices
};

// The transforms at the next frame's time, only where motion is asked for.
struct NextInstance {
  vec4 row0;
  vec4 row1;
  vec4 row2;
};

// Stream 0: what every pass needs. The normal is octahedral, 16-bit signed-normalised.
struct VertexPosition {
  vec3 position;
  uint normal;
};
// Stream 1: what shading needs.
struct VertexSurface {
  vec2 uv0;
  vec2 uv1;
  uint tangent;  // octahedral 15 + 16 bits; bit 16: handedness
  // Linear RGBA of 16 bits each: with 8 the darkest step, 1/255, would be 13 grey levels of sRGB.
  uint color_rg;
  uint color_ba;
};

NERITIC_CONST uint kMaterialBaseColorTexture = 1;
NERITIC_CONST uint kMaterialMetalRoughTexture = 2;
NERITIC_CONST uint kMaterialNormalTexture = 4;
NERITIC_CONST uint kMaterialOcclusionTexture = 8;
NERITIC_CONST uint kMaterialEmissiveTexture = 16;
NERITIC_CONST uint kMaterialUnlit = 32;
NERITIC_CONST uint kMaterialVertexColor = 64;
NERITIC_CONST uint kMaterialMask = 128;
NERITIC_CONST uint kMaterialTransmissive = 256;
NERITIC_CONST uint kMaterialThin = 512;  // diffuse_transmission is above 0
NERITIC_CONST uint kMaterialDetailTexture = 1024;
NERITIC_CONST uint kMaterialTextures = 1055;  // any of them
NERITIC_CONST uint kMaterialSecondUv = 2048;  // some texture uses the second UV set

// KHR_texture_transform and the UV set of one texture.
struct TextureMapping {
  vec3 u;
  vec3 v;
  uint uv_set;
};

// The G-buffer's fourth number of a material: its reflectance, at most kMaxReflectance, or 1 for
// unlit.
NERITIC_CONST float kMaxReflectance = 0.8f;

struct MaterialData {
  vec4 base_color;
  vec3 emissive;
  float metallic;
  float roughness;
  float reflectance;  // (n - 1) / (n + 1) of the index of refraction; squared: at normal incidence
  float normal_scale;
  float occlusion_strength;
  float alpha_cutoff;
  TextureMapping base_color_map;
  TextureMapping metal_rough_map;
  TextureMapping normal_map;
  TextureMapping occlusion_map;
  TextureMapping emissive_map;
  float diffuse_transmission;
  TextureMapping detail_map;  // ends a row of eight: shared/material.glsl
};

// Locations of the instance streams; a vertex's own are 0 to 5.
NERITIC_CONST uint kInstanceRow0 = 6;
NERITIC_CONST uint kInstanceRow1 = 7;
NERITIC_CONST uint kInstanceRow2 = 8;
NERITIC_CONST uint kInstanceLabel = 9;  // label, deformed
NERITIC_CONST uint kNextInstanceRow0 = 10;
NERITIC_CONST uint kNextInstanceRow1 = 11;
NERITIC_CONST uint kNextInstanceRow2 = 12;

// Set 0 of the raster passes.
NERITIC_CONST uint kRasterViews = 0;
NERITIC_CONST uint kRasterNextPositions = 1;  // deformed positions at the next frame's time
NERITIC_CONST uint kRasterLighting = 2;       // forward pass only
// Set 1: a material.
NERITIC_CONST uint kMaterialConstants = 0;
NERITIC_CONST uint kMaterialBaseColor = 1;
NERITIC_CONST uint kMaterialMetalRough = 2;
NERITIC_CONST uint kMaterialNormal = 3;
NERITIC_CONST uint kMaterialOcclusion = 4;
NERITIC_CONST uint kMaterialEmissive = 5;
NERITIC_CONST uint kMaterialDetail = 6;

// Specialisation constants. A processor's driver computes both sides of a branch and loads lane by
// lane what an index picks that it cannot prove uniform, so both the texture reads of a material
// and the view are settled when the pipeline is made.
NERITIC_CONST uint kSpecMotion = 0;
NERITIC_CONST uint kSpecMaterial = 1;      // the material's flags
NERITIC_CONST uint kSpecMultiview = 2;     // 0: the set has one view
NERITIC_CONST uint kSpecForwardGlow = 3;   // samples of a lamp's beam before blended surfaces
NERITIC_CONST uint kSpecForwardTerms = 4;  // of light, and the number of lamps
NERITIC_CONST uint kSpecForwardLamps = 5;

struct RasterPush {
  vec2 target_size;  // pixels, for motion
};

// The deform pass: skin and morph one primitive of one instance.
NERITIC_CONST uint kDeformGroup = 64;
NERITIC_CONST uint kDeformPositions = 0;  // VertexPosition[], the mesh's own
NERITIC_CONST uint kDeformSkin = 1;       // SkinVertex[]
NERITIC_CONST uint kDeformJoints = 2;     // mat4[], now, then at the next time
NERITIC_CONST uint kDeformMorphs = 3;     // MorphDelta[]
NERITIC_CONST uint kDeformWeights = 4;    // float[], now, then next
NERITIC_CONST uint kDeformOut = 5;        // VertexPosition[]
NERITIC_CONST uint kDeformNextOut = 6;    // vec3[]

struct SkinVertex {
  uint joints01;  // two 16-bit indices
  uint joints23;
  vec4 weights;
};
struct MorphDelta {
  vec3 position;
  vec3 normal;
};
struct DeformPush {
  uint vertex_count;
  uint first_source;   // in the mesh's stream
  uint first_skin;     // in the skin stream; ~0: no skin
  uint first_joint;    // this instance's matrices now
  uint joint_stride;   // distance to the next time's
  uint first_morph;    // target-major: target * vertex_count + vertex
  uint morph_targets;  // 0: none
  uint first_weight;
  uint weight_stride;
  uint first_out;
  uint next;  // 1: also write the next time's positions
};

NERITIC_SHARED_END
#endif
