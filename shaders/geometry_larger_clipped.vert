#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_multiview : require

#define NERITIC_LARGER
#define NERITIC_CLIPPED
#include "shared/geometry_vertex.glsl"
