// Terms of a camera beyond a pinhole: lens, image sensor, white balance, vignette, a linear
// picture. Each is absent, and unpaid, unless the scene names it. Plain values; any thread.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/core/intrinsics.hpp"
#include "engine/core/math.hpp"
#include "engine/core/result.hpp"

namespace neritic::scene {

enum class LensModel { kBrownConrady, kFisheye };

enum class PortKind { kNone, kFlat, kDome };
inline constexpr const char* kPortNames[] = {"none", "flat", "dome"};
// Index of water against air (shaders/shared/lighting.h).
inline constexpr double kPortIndex = 1.333;

// The window of a housing: outside of it is water. A flat one magnifies by the index and bends the
// more the farther off the axis; a dome about the lens's entrance pupil bends nothing.
struct Port {
  PortKind kind = PortKind::kNone;
  double offset = 0.0;  // of the pupil before a dome's centre, over its radius
};

// Brown (1971) and Conrady (1919): k of r^2, r^4, r^6, p of the decentring, in OpenCV's order and
// signs; or Kannala and Brandt (2006) as OpenCV's fisheye: an angle's radius is
// angle (1 + k_0 angle^2 + k_1 angle^4 + k_2 angle^6 + k_3 angle^8).
struct Lens {
  LensModel model = LensModel::kBrownConrady;
  std::array<double, 4> k{};
  std::array<double, 2> p{};
  Port port;  // in front of it
};

enum class Bayer { kNone, kRggb, kBggr, kGrbg, kGbrg };
inline constexpr const char* kBayerNames[] = {"none", "rggb", "bggr", "grbg", "gbrg"};

// Photons to counts (EMVA 1288, release 4: a linear camera). The exposure says how bright a picture
// is; the gain, which part of that the amplifier does instead of light.
struct ImageSensor {
  double gain_db = 0.0;
  double full_well_e = 10000.0;  // electrons at saturation without gain
  double read_noise_e = 3.0;     // standard deviation
  double saturation_ev = 2.0;    // stops from a white surface in the scene's light to saturation
  std::uint32_t bits = 12;       // of the converter
  Bayer bayer = Bayer::kNone;    // of the raw picture; kNone: there is none

  // Electrons of an exposed radiance of 1, and the exposed radiance that saturates.
  double electrons_per_unit() const;
  double saturation() const;
};

struct WhiteBalance {
  bool automatic = false;  // a white card at the camera becomes neutral, within 2 stops
  Vec3 gains{1.0};         // else these
};

// Depth of field of a thin lens.
struct Focus {
  double distance_m = 2.0, f_number = 2.8, focal_length_m = 0.011;
  std::uint32_t samples = 24;  // that a pixel gathers
};

// Blurs what moves while the shutter is open; rows are read one after another.
struct Shutter {
  double exposure_s = 0.008, readout_s = 0.0;  // of a row; from the first row to the last
  std::uint32_t samples = 8;
};

// A response to light at a wavelength, per channel.
struct ResponseRow {
  double wavelength_nm = 550.0;
  Vec3 channels{0.0};
};

// Light in bands of even width from 400 to 700 nm, three of which are shaded at a time, and joined
// by the camera's response.
struct Spectrum {
  std::uint32_t bands = 12;           // 9, 12 or 15
  std::vector<ResponseRow> response;  // by rising wavelength; empty: the eye's (CIE 1931)
};

struct CameraTerms {
  std::optional<Spectrum> spectrum;  // absent: light at 600, 550 and 450 nm
  std::optional<Lens> lens;
  std::optional<Focus> focus;
  std::optional<Shutter> shutter;
  std::optional<ImageSensor> sensor;
  std::optional<WhiteBalance> white_balance;
  double vignette = 0.0;  // times cos^4 in the exponent; 0: none
  bool linear = false;    // the picture before the tone curve too
  bool changes_picture() const {
    return spectrum || lens || focus || shutter || sensor || white_balance || vignette > 0.0;
  }
};

// The pinhole that a lens's picture is made from: it sees all that the lens sees.
struct LensView {
  Intrinsics lens;    // of the lens's picture: pixels = focal length * distorted point + centre
  Intrinsics source;  // of the pinhole
  FrustumTangents tangents;
  std::uint32_t width = 1, height = 1;  // of the pinhole's picture
};
// fov_rad: vertical; of a fisheye as it sees, of Brown and Conrady before distortion. kBadInput
// where a pixel's ray is more than 80 degrees off the axis, or two rays meet in one pixel.
Result<LensView> lens_view(const Lens& lens, std::uint32_t width, std::uint32_t height,
                           double fov_rad);

// Points of the plane at distance 1, x to the right and y down: without a lens and through it.
glm::dvec2 through_lens(const Lens& lens, const glm::dvec2& plane);
glm::dvec2 before_lens(const Lens& lens, const glm::dvec2& image);
// Whether the lens turns nothing inside out on the way from the axis to that point of the plane.
bool unfolded(const Lens& lens, const glm::dvec2& plane);

}  // namespace neritic::scene
