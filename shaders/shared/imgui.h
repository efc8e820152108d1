// Shared by the overlay's pass and its shaders: Dear ImGui's triangles in pixels, one texture a
// draw.
#ifndef NERITIC_SHARED_IMGUI_H
#define NERITIC_SHARED_IMGUI_H
#include "shared/types.h"

NERITIC_SHARED_BEGIN

struct ImguiPush {
  vec2 clip_from_pixel;  // scale; the offset is -1, -1
  uint layer;            // of the texture
};

// Vertex locations: position (pixels), uv, colour (RGBA8, sRGB, straight alpha).
NERITIC_CONST uint kImguiPosition = 0;
NERITIC_CONST uint kImguiUv = 1;
NERITIC_CONST uint kImguiColor = 2;
NERITIC_CONST uint kImguiTexture = 0;  // binding

// Specialisation constant: triangles of one colour, which need no texture.
NERITIC_CONST uint kSpecImguiPlain = 0;

NERITIC_SHARED_END
#endif
