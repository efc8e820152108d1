#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_multiview : require

// Vertex stage of depth alone: the maps of sun and lamps. There is no fragment stage.
#define NERITIC_DEPTH
#include "shared/raster_vertex.glsl"

void main() { place_vertex(); }
