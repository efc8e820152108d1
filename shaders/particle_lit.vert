#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_multiview : require

// A particle in light shafts.
#define NERITIC_PARTICLE_SHAFTS
#include "shared/particle_vertex.glsl"
