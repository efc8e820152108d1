// Shared by the pass that draws a display's panels and its shaders: a flat rectangle in each view
// of a group, with one texture.
#ifndef NERITIC_SHARED_PANEL_H
#define NERITIC_SHARED_PANEL_H
#include "shared/types.h"

NERITIC_SHARED_BEGIN

// In the clip space of one view: the corner (x, y), each -1 or 1 (x right, y up), is at
// middle + x right + y up.
struct PanelCorners {
  vec4 middle;
  vec4 right;
  vec4 up;
  vec4
      part;  // that is drawn: left, top, right, bottom, each 0 to 1 from the texture's left and top
};

NERITIC_CONST uint kMaxPanelViews = 4;  // of one group

// Bindings.
NERITIC_CONST uint kPanelCorners = 0;  // PanelCorners[kMaxPanelViews]
NERITIC_CONST uint kPanelTexture = 1;

// Specialisation constant: the texture covers the picture texel on pixel, so that nothing is
// filtered. On a CPU a filtered sample costs several times as much.
NERITIC_CONST uint kSpecPanelTexels = 0;

NERITIC_SHARED_END
#endif
