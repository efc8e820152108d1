// Wrenches that swing as a sine, of a trajectory file's `tau_sin`. One thread.
//
// Written as an object, or a list of objects whose sum counts. A member's meaning is what its name
// begins with (in any case of letters):
//   amp..., A, tau...: the amplitude, six numbers, or one with axis: 0 to 5, or X Y Z K M N
//   omega..., w, ...rad...: rad/s; or f..., ...hz: Hz; or period..., T: s. One number, or six
//   ph...: phase, rad, or degrees where the name says deg. One number, or six [0]
// or as rows [axis, amplitude, omega, phase], as six rows [amplitude, omega, phase], or as columns
// [amplitudes, omega, phase] of six numbers; phase [0].
#pragma once

#include <vector>

#include "engine/core/case_file.hpp"
#include "rov/vector6.hpp"

namespace neritic::rov {

struct SineWrench {
  Vec6 amplitude, rad_s, phase_rad;

  Vec6 at(double t_s) const {
    Vec6 out;
    for (std::size_t i = 0; i < 6; ++i)
      if (amplitude[i] != 0.0) out[i] = amplitude[i] * std::sin(rad_s[i] * t_s + phase_rad[i]);
    return out;
  }
};

// Empty where the field is absent or refused.
std::vector<SineWrench> read_sines(const CaseField& field);

}  // namespace neritic::rov
