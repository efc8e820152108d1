// Shared by the pass that hides what a headset's lenses cannot show, and its shader.
#ifndef NERITIC_SHARED_HIDDEN_H
#define NERITIC_SHARED_HIDDEN_H
#include "shared/types.h"

NERITIC_SHARED_BEGIN

// Binding: places in the picture, -1 to 1 and y down, corner by corner, each for kMaxViews views.
NERITIC_CONST uint kHiddenCorners = 0;

NERITIC_SHARED_END
#endif
