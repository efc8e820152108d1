// FLIP: how much a person sees that two pictures differ who are shown one after the other in one
// place (Andersson, Nilsson, Akenine-Moeller, Oskarsson, Astroem, Fairchild 2020, "FLIP: A
// Difference Evaluator for Alternating Images", Proc. ACM Comput. Graph. Interact. Tech. 3(2)):
// colours after the eye's contrast sensitivity, in the HyAB distance with Hunt's effect, raised
// where edges and points differ.
#pragma once

#include "engine/core/image.hpp"

namespace neritic::tools {

// A monitor 0.7 m wide with 3840 pixels, seen from 0.7 m: as in the paper.
inline constexpr double kFlipPixelsADegree = 67.0206;

// Of each pixel, from 0 (looks the same) to 1, of two pictures of one size in sRGB with 3 channels.
// Any thread.
ImageF32 flip_map(const ImageU8& shown, const ImageU8& wanted,
                  double pixels_a_degree = kFlipPixelsADegree);
// Its mean; 0 for a picture without pixels.
double flip_error(const ImageU8& shown, const ImageU8& wanted,
                  double pixels_a_degree = kFlipPixelsADegree);

}  // namespace neritic::tools
