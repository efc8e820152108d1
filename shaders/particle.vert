#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_multiview : require

// A particle without light shafts.
#include "shared/particle_vertex.glsl"
