// Shared by the pass that brings a picture to a headset and its shaders.
#ifndef NERITIC_SHARED_PRESENT_H
#define NERITIC_SHARED_PRESENT_H
#include "shared/types.h"

NERITIC_SHARED_BEGIN

NERITIC_CONST uint kPresentPicture = 0;     // binding; an array layer a view
NERITIC_CONST uint kSpecPresentOpaque = 0;  // constant: 1: alpha counts as 1

NERITIC_SHARED_END
#endif
