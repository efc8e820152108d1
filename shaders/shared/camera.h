// The camera pass: what lens and image sensor make of exposed radiance (shaders/camera.comp).
#ifndef NERITIC_SHARED_CAMERA_H
#define NERITIC_SHARED_CAMERA_H
#include "shared/lens.h"

NERITIC_SHARED_BEGIN

NERITIC_CONST uint kCameraLens = 1;  // by CameraParams::model
NERITIC_CONST uint kCameraVignette = 2;
NERITIC_CONST uint kCameraNoise = 4;
NERITIC_CONST uint kCameraWhite = 8;

// Pixels = focal_px * point + center_px, of the picture that the pass makes and of its source.
struct CameraParams {
  uint model;
  vec4 k;
  vec2 p;
  uint port;  // kPort...
  float port_offset;
  float focal_px;
  vec2 center_px;
  float source_focal_px;
  vec2 source_center_px;
  float vignette;      // of the exponent 4
  vec3 white;          // gains
  float electrons;     // of an exposed radiance of 1
  float read_noise_e;  // standard deviation
  float saturation;    // exposed radiance
  float steps;         // of the converter from 0 to saturation
  uint seed;
  uint stream;
  uint frame;
};

// Bindings, and the specialisation constant with the terms.
NERITIC_CONST uint kCameraHdr = 0;
NERITIC_CONST uint kCameraOut = 1;
NERITIC_CONST uint kCameraData = 2;
NERITIC_CONST uint kSpecCameraTerms = 0;

NERITIC_SHARED_END
#endif
