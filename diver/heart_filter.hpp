// The band in which a heart's QRS complex stands out, for any sampling rate: an FIR of exact linear
// phase, so that a beat's time is known to the sample. One owner, one thread.
#pragma once

#include <vector>

namespace neritic::diver {

// 5 to 15 Hz (Pan and Tompkins 1985, IEEE Trans. Biomed. Eng. 32, 230). Their integer filters are
// for 200 Hz; this is a windowed sinc (Hamming) over 0.4 s, at any rate, that gives exactly nothing
// for a constant.
inline constexpr double kQrsLow_hz = 5.0, kQrsHigh_hz = 15.0;

// An odd number of taps, symmetric.
std::vector<double> qrs_band_taps(double rate_hz);

}  // namespace neritic::diver
