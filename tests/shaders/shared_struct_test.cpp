// Every struct that GLSL and C++ share has the same members at the same places in both: the offsets
// that SPIR-V declares (read with SPIRV-Cross) against offsetof.
#include <gtest/gtest.h>
#include <spirv_cross/spirv_cross_c.h>

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <string_view>

#include "shaders.hpp"
#include "shared/bands.h"
#include "shared/camera.h"
#include "shared/caustics.h"
#include "shared/exposure.h"
#include "shared/forward_scatter.h"
#include "shared/imgui.h"
#include "shared/lighting.h"
#include "shared/panel.h"
#include "shared/particles.h"
#include "shared/raster.h"
#include "shared/shafts.h"
#include "shared/shimmer.h"
#include "shared/skylight.h"
#include "shared/sonar.h"
#include "shared/sonar_echo.h"
#include "shared/sonar_fan.h"
#include "shared/visibility.h"
#include "shared/waves.h"

namespace neritic::shared {
namespace {

using Offsets = std::map<std::string, std::size_t>;

#define MEMBER(type, member) \
  { #member, offsetof(type, member) }

const std::map<std::string, Offsets>& shared_structs() {
  static const std::map<std::string, Offsets> structs{
      {"View",
       {MEMBER(View, clip_from_origin), MEMBER(View, next_clip_from_origin), MEMBER(View, eye),
        MEMBER(View, near_m), MEMBER(View, ray_corner), MEMBER(View, ray_dx), MEMBER(View, ray_dy),
        MEMBER(View, within)}},

      {"VertexPosition", {MEMBER(VertexPosition, position), MEMBER(VertexPosition, normal)}},
      {"TextureMapping",
       {MEMBER(TextureMapping, u), MEMBER(TextureMapping, v), MEMBER(TextureMapping, uv_set)}},
      {"MaterialData",
       {MEMBER(MaterialData, base_color), MEMBER(MaterialData, emissive),
        MEMBER(MaterialData, metallic), MEMBER(MaterialData, roughness),
        MEMBER(MaterialData, reflectance), MEMBER(MaterialData, normal_scale),
        MEMBER(MaterialData, occlusion_strength), MEMBER(MaterialData, alpha_cutoff),
        MEMBER(MaterialData, base_color_map), MEMBER(MaterialData, metal_rough_map),
        MEMBER(MaterialData, normal_map), MEMBER(MaterialData, occlusion_map),
        MEMBER(MaterialData, emissive_map), MEMBER(MaterialData, diffuse_transmission),
        MEMBER(MaterialData, detail_map)}},
      {"RasterPush", {MEMBER(RasterPush, target_size)}},
      {"SkinVertex",
       {MEMBER(SkinVertex, joints01), MEMBER(SkinVertex, joints23), MEMBER(SkinVertex, weights)}},
      {"MorphDelta", {MEMBER(MorphDelta, position), MEMBER(MorphDelta, normal)}},
      {"DeformPush",
       {MEMBER(DeformPush, vertex_count), MEMBER(DeformPush, first_source),
        MEMBER(DeformPush, first_skin), MEMBER(DeformPush, first_joint),
        MEMBER(DeformPush, joint_stride), MEMBER(DeformPush, first_morph),
        MEMBER(DeformPush, morph_targets), MEMBER(DeformPush, first_weight),
        MEMBER(DeformPush, weight_stride), MEMBER(DeformPush, first_out),
        MEMBER(DeformPush, next)}},
      {"SpotLight",
       {MEMBER(SpotLight, position), MEMBER(SpotLight, direction), MEMBER(SpotLight, intensity_cd),
        MEMBER(SpotLight, cos_inner), MEMBER(SpotLight, cos_outer), MEMBER(SpotLight, profiled),
        MEMBER(SpotLight, profile)}},
      {"SkylightParams",
       {MEMBER(SkylightParams, low), MEMBER(SkylightParams, cell_m), MEMBER(SkylightParams, nx),
        MEMBER(SkylightParams, ny), MEMBER(SkylightParams, nz)}},
      {"Lighting",
       {MEMBER(Lighting, terms),
        MEMBER(Lighting, lamp_count),
        MEMBER(Lighting, to_sun),
        MEMBER(Lighting, surface_irradiance),
        MEMBER(Lighting, direct_share),
        MEMBER(Lighting, origin_depth_m),
        MEMBER(Lighting, diffuse_attenuation),
        MEMBER(Lighting, beam_attenuation),
        MEMBER(Lighting, water_scattering),
        MEMBER(Lighting, particle_scattering),
        MEMBER(Lighting, background),
        MEMBER(Lighting, emissive_scale),
        MEMBER(Lighting, exposure),
        MEMBER(Lighting, sun_cosine),
        MEMBER(Lighting, bottom_color),
        MEMBER(Lighting, bottom_depth_m),
        MEMBER(Lighting, caustic_origin_m),
        MEMBER(Lighting, caustic_tile_m),
        MEMBER(Lighting, murk_bed_m),
        MEMBER(Lighting, murk_thickness_m),
        MEMBER(Lighting, murk_more),
        MEMBER(Lighting, lamps)}},
      {"LampShadows",
       {MEMBER(LampShadows, clip_from_origin), MEMBER(LampShadows, near_m),
        MEMBER(LampShadows, layer)}},
      {"Cascade",
       {MEMBER(Cascade, clip_from_origin), MEMBER(Cascade, across), MEMBER(Cascade, along),
        MEMBER(Cascade, near_m), MEMBER(Cascade, half_m)}},
      {"VisibilityParams",
       {MEMBER(VisibilityParams, cascades), MEMBER(VisibilityParams, to_sun),
        MEMBER(VisibilityParams, origin_depth_m), MEMBER(VisibilityParams, spread),
        MEMBER(VisibilityParams, scattering_m), MEMBER(VisibilityParams, sun_cosine),
        MEMBER(VisibilityParams, occlusion_m)}},
      {"CausticWave",
       {MEMBER(CausticWave, wave_number), MEMBER(CausticWave, amplitude_m),
        MEMBER(CausticWave, angle_rad)}},
      {"CausticsParams",
       {MEMBER(CausticsParams, count), MEMBER(CausticsParams, texels),
        MEMBER(CausticsParams, tile_m), MEMBER(CausticsParams, first_m),
        MEMBER(CausticsParams, step), MEMBER(CausticsParams, first_level),
        MEMBER(CausticsParams, end_level), MEMBER(CausticsParams, travel_air),
        MEMBER(CausticsParams, waves)}},
      {"Wave", {MEMBER(Wave, wave_number), MEMBER(Wave, amplitude_m), MEMBER(Wave, angle_rad)}},
      {"Waves",
       {MEMBER(Waves, count), MEMBER(Waves, height_rms_m), MEMBER(Waves, slope2),
        MEMBER(Waves, fine_slope2), MEMBER(Waves, foam_height_m), MEMBER(Waves, foam_shift),
        MEMBER(Waves, eye_height_m), MEMBER(Waves, eye_slope), MEMBER(Waves, waves)}},
      {"CameraParams",
       {MEMBER(CameraParams, model), MEMBER(CameraParams, k), MEMBER(CameraParams, p),
        MEMBER(CameraParams, port), MEMBER(CameraParams, port_offset),
        MEMBER(CameraParams, focal_px), MEMBER(CameraParams, center_px),
        MEMBER(CameraParams, source_focal_px), MEMBER(CameraParams, source_center_px),
        MEMBER(CameraParams, vignette), MEMBER(CameraParams, white),
        MEMBER(CameraParams, electrons), MEMBER(CameraParams, read_noise_e),
        MEMBER(CameraParams, saturation), MEMBER(CameraParams, steps), MEMBER(CameraParams, seed),
        MEMBER(CameraParams, stream), MEMBER(CameraParams, frame)}},
      {"ScatterPush",
       {MEMBER(ScatterPush, scattering), MEMBER(ScatterPush, high_cycles_rad),
        MEMBER(ScatterPush, low_cycles_rad), MEMBER(ScatterPush, angle_rad)}},
      {"BandParams", {MEMBER(BandParams, rows)}},
      {"ShimmerWave",
       {MEMBER(ShimmerWave, number_m), MEMBER(ShimmerWave, slope), MEMBER(ShimmerWave, angle_rad)}},
      {"ShimmerLayer",
       {MEMBER(ShimmerLayer, height_m), MEMBER(ShimmerLayer, sigma_m), MEMBER(ShimmerLayer, bend),
        MEMBER(ShimmerLayer, waves)}},
      {"ShimmerParams", {MEMBER(ShimmerParams, layers)}},
      {"ShaftParams", {MEMBER(ShaftParams, reach_m)}},
      {"FocusParams",
       {MEMBER(FocusParams, near_m), MEMBER(FocusParams, focus_m), MEMBER(FocusParams, opening_px),
        MEMBER(FocusParams, widest_px), MEMBER(FocusParams, samples)}},
      {"ShutterParams",
       {MEMBER(ShutterParams, exposed), MEMBER(ShutterParams, readout),
        MEMBER(ShutterParams, samples), MEMBER(ShutterParams, farthest_px),
        MEMBER(ShutterParams, by_lens), MEMBER(ShutterParams, tiles), MEMBER(ShutterParams, row)}},
      {"ShadePush", {MEMBER(ShadePush, first_group), MEMBER(ShadePush, first_tile)}},
      {"ShadeTilesPush",
       {MEMBER(ShadeTilesPush, wide), MEMBER(ShadeTilesPush, high),
        MEMBER(ShadeTilesPush, near_m), MEMBER(ShadeTilesPush, sea_off_m),
        MEMBER(ShadeTilesPush, sea_clearest), MEMBER(ShadeTilesPush, ray_corner),
        MEMBER(ShadeTilesPush, ray_dx), MEMBER(ShadeTilesPush, ray_dy)}},
      {"Particle",
       {MEMBER(Particle, position), MEMBER(Particle, radius_m), MEMBER(Particle, moved),
        MEMBER(Particle, opacity), MEMBER(Particle, kind), MEMBER(Particle, seed)}},
      {"ParticlePush", {MEMBER(ParticlePush, target_size), MEMBER(ParticlePush, shutter)}},
      {"SonarColumn",
       {MEMBER(SonarColumn, beam_base), MEMBER(SonarColumn, sec_theta), MEMBER(SonarColumn, right),
        MEMBER(SonarColumn, pixel_tan), MEMBER(SonarColumn, up), MEMBER(SonarColumn, forward),
        MEMBER(SonarColumn, pixel), MEMBER(SonarColumn, layer), MEMBER(SonarColumn, first_pixel),
        MEMBER(SonarColumn, end_pixel), MEMBER(SonarColumn, tan_theta)}},
      {"SonarPush",
       {MEMBER(SonarPush, n_range),
        MEMBER(SonarPush, n_azimuth),
        MEMBER(SonarPush, n_elevation),
        MEMBER(SonarPush, width),
        MEMBER(SonarPush, height),
        MEMBER(SonarPush, fx),
        MEMBER(SonarPush, fy),
        MEMBER(SonarPush, cx),
        MEMBER(SonarPush, cy),
        MEMBER(SonarPush, near_m),
        MEMBER(SonarPush, range_min_m),
        MEMBER(SonarPush, bins_per_m),
        MEMBER(SonarPush, bin_m),
        MEMBER(SonarPush, fixed_scale),
        MEMBER(SonarPush, edge_bias_bins),
        MEMBER(SonarPush, reflectivities),
        MEMBER(SonarPush, lean),
        MEMBER(SonarPush, azimuth_step_rad),
        MEMBER(SonarPush, first_row),
        MEMBER(SonarPush, end_row),
        MEMBER(SonarPush, first_v),
        MEMBER(SonarPush, end_v),
        MEMBER(SonarPush, drawn_larger),
        MEMBER(SonarPush, surface_m)}},
      {"SonarEcho",
       {MEMBER(SonarEcho, motion),
        MEMBER(SonarEcho, sum_scale),
        MEMBER(SonarEcho, doppler),
        MEMBER(SonarEcho, turns_per_m),
        MEMBER(SonarEcho, cell_fraction),
        MEMBER(SonarEcho, cells_per_m),
        MEMBER(SonarEcho, origin_cell),
        MEMBER(SonarEcho, seed),
        MEMBER(SonarEcho, patch_fraction),
        MEMBER(SonarEcho, patches_per_m),
        MEMBER(SonarEcho, origin_patch),
        MEMBER(SonarEcho, correction_width),
        MEMBER(SonarEcho, world_up),
        MEMBER(SonarEcho, correction_height),
        MEMBER(SonarEcho, correction_range_m),
        MEMBER(SonarEcho, water_level_m),
        MEMBER(SonarEcho, water_sign),
        MEMBER(SonarEcho, ghost_weight),
        MEMBER(SonarEcho, ghost_source),
        MEMBER(SonarEcho, ghost_spreading),
        MEMBER(SonarEcho, head_right),
        MEMBER(SonarEcho, elevation_min_rad),
        MEMBER(SonarEcho, head_up),
        MEMBER(SonarEcho, rows_per_rad),
        MEMBER(SonarEcho, head_back),
        MEMBER(SonarEcho, azimuth_min_rad),
        MEMBER(SonarEcho, columns_per_rad),
        MEMBER(SonarEcho, solid_angle),
        MEMBER(SonarEcho, cells_per_range),
        MEMBER(SonarEcho, least_cells),
        MEMBER(SonarEcho, column_rad),
        MEMBER(SonarEcho, mirror_class)}},
      {"SonarDrawnLarger",
       {MEMBER(SonarDrawnLarger, true_from_drawn), MEMBER(SonarDrawnLarger, offset_m),
        MEMBER(SonarDrawnLarger, direct_rad), MEMBER(SonarDrawnLarger, label),
        MEMBER(SonarDrawnLarger, direct)}},
      {"SonarRecord",
       {MEMBER(SonarRecord, bin), MEMBER(SonarRecord, counts), MEMBER(SonarRecord, label),
        MEMBER(SonarRecord, ends)}},
      {"SonarReceiverPush",
       {MEMBER(SonarReceiverPush, columns), MEMBER(SonarReceiverPush, rows),
        MEMBER(SonarReceiverPush, out_columns), MEMBER(SonarReceiverPush, stride),
        MEMBER(SonarReceiverPush, first), MEMBER(SonarReceiverPush, taps),
        MEMBER(SonarReceiverPush, scale), MEMBER(SonarReceiverPush, first_shift),
        MEMBER(SonarReceiverPush, shift), MEMBER(SonarReceiverPush, shift_right),
        MEMBER(SonarReceiverPush, shift_back), MEMBER(SonarReceiverPush, first_bearing_rad),
        MEMBER(SonarReceiverPush, bearing_step_rad), MEMBER(SonarReceiverPush, noise),
        MEMBER(SonarReceiverPush, seed), MEMBER(SonarReceiverPush, ping),
        MEMBER(SonarReceiverPush, tap_correlation)}},
      {"SonarFanPush",
       {MEMBER(SonarFanPush, width), MEMBER(SonarFanPush, height), MEMBER(SonarFanPush, n_range),
        MEMBER(SonarFanPush, n_azimuth), MEMBER(SonarFanPush, left_m), MEMBER(SonarFanPush, top_m),
        MEMBER(SonarFanPush, m_per_px), MEMBER(SonarFanPush, range_min_m),
        MEMBER(SonarFanPush, bins_per_m), MEMBER(SonarFanPush, azimuth_middle_rad),
        MEMBER(SonarFanPush, azimuth_half_rad), MEMBER(SonarFanPush, bins_per_rad),
        MEMBER(SonarFanPush, gamma), MEMBER(SonarFanPush, gain), MEMBER(SonarFanPush, is_power),
        MEMBER(SonarFanPush, is_opaque)}},
      {"SonarFanScalePush",
       {MEMBER(SonarFanScalePush, cells), MEMBER(SonarFanScalePush, stride),
        MEMBER(SonarFanScalePush, quantile), MEMBER(SonarFanScalePush, follow),
        MEMBER(SonarFanScalePush, is_power)}},
      {"PanelCorners",
       {MEMBER(PanelCorners, middle), MEMBER(PanelCorners, right), MEMBER(PanelCorners, up),
        MEMBER(PanelCorners, part)}},
      {"ImguiPush", {MEMBER(ImguiPush, clip_from_pixel), MEMBER(ImguiPush, layer)}}};
  return structs;
}

class Walker {
 public:
  explicit Walker(std::set<std::string>& seen) : seen_(seen) {}

  void stage(const shaders::Stage& stage) {
    spvc_context context = nullptr;
    ASSERT_EQ(spvc_context_create(&context), SPVC_SUCCESS);
    spvc_parsed_ir ir = nullptr;
    ASSERT_EQ(spvc_context_parse_spirv(context, stage.code.data(), stage.code.size(), &ir),
              SPVC_SUCCESS)
        << stage.file;
    ASSERT_EQ(spvc_context_create_compiler(context, SPVC_BACKEND_NONE, ir,
                                           SPVC_CAPTURE_MODE_TAKE_OWNERSHIP, &compiler_),
              SPVC_SUCCESS);
    spvc_resources resources = nullptr;
    ASSERT_EQ(spvc_compiler_create_shader_resources(compiler_, &resources), SPVC_SUCCESS);
    for (const spvc_resource_type kind :
         {SPVC_RESOURCE_TYPE_STORAGE_BUFFER, SPVC_RESOURCE_TYPE_UNIFORM_BUFFER,
          SPVC_RESOURCE_TYPE_PUSH_CONSTANT}) {
      const spvc_reflected_resource* list = nullptr;
      std::size_t count = 0;
      ASSERT_EQ(spvc_resources_get_resource_list_for_type(resources, kind, &list, &count),
                SPVC_SUCCESS);
      for (std::size_t i = 0; i < count; ++i) type(list[i].base_type_id, stage.file, true);
    }
    spvc_context_destroy(context);
  }

 private:
  // block: an interface block, which only GLSL names; a struct inside one is shared and must be in
  // the table.
  void type(spvc_type_id id, const char* file, bool block) {
    const spvc_type handle = spvc_compiler_get_type_handle(compiler_, id);
    if (spvc_type_get_basetype(handle) != SPVC_BASETYPE_STRUCT) return;
    const spvc_type_id base = spvc_type_get_base_type_id(handle);
    const std::string name = spvc_compiler_get_name(compiler_, base);
    const auto known = shared_structs().find(name);
    const unsigned members = spvc_type_get_num_member_types(handle);
    if (known != shared_structs().end()) {
      seen_.insert(name);
      EXPECT_EQ(members, known->second.size()) << file << ": " << name;
    }
    EXPECT_TRUE(block || known != shared_structs().end())
        << file << ": struct " << name << " is not in the test's table";
    for (unsigned m = 0; m < members; ++m) {
      if (known != shared_structs().end()) {
        unsigned offset = 0;
        ASSERT_EQ(spvc_compiler_type_struct_member_offset(compiler_, handle, m, &offset),
                  SPVC_SUCCESS);
        const std::string member = spvc_compiler_get_member_name(compiler_, base, m);
        const auto row = known->second.find(member);
        ASSERT_NE(row, known->second.end())
            << file << ": " << name << "." << member << " is not in the test's table";
        EXPECT_EQ(offset, row->second) << file << ": " << name << "." << member;
      }
      type(spvc_type_get_member_type(handle, m), file, false);
    }
  }

  spvc_compiler compiler_ = nullptr;
  std::set<std::string>& seen_;
};

TEST(SharedStructs, LieAtTheSameOffsetsInShadersAndHost) {
  std::set<std::string> seen;
  for (const shaders::Stage& stage : shaders::all_stages())
    if (!std::string_view(stage.file).starts_with("test_"))
      Walker(seen).stage(stage);  // those have structs of their own
  for (const auto& [name, members] : shared_structs())
    EXPECT_TRUE(seen.contains(name)) << name << " is in no shader's interface";
}

}  // namespace
}  // namespace neritic::shared
