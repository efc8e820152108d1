// Shared by the receiver's passes.
#include "shared/sonar_echo.h"

layout(local_size_x = kReceiverGroup, local_size_y = kReceiverGroup) in;
layout(constant_id = kReceiverSpecCoherent) const uint kCoherent = 0;
layout(push_constant, scalar) uniform Push { SonarReceiverPush pushed; };
SonarReceiverPush c;  // main copies it at its start, as in sonar_common.glsl
