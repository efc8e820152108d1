#include "tools/tradeoff/physiology_signals.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "diver/physio_wav.hpp"
#include "engine/core/files.hpp"
#include "engine/core/math.hpp"
#include "engine/core/refusal.hpp"

namespace neritic::tools {
namespace {

constexpr double kMadeSound_hz = 4000.0;

// Rest at 65, a climb to 140 in half a minute, a stay, and a slow way back.
double effort_rate_bpm(double t_s) {
  const double up = std::clamp((t_s - 60.0) / 30.0, 0.0, 1.0);
  const double down = std::clamp((t_s - 150.0) / 60.0, 0.0, 1.0);
  return 65.0 + 75.0 * (up * up * (3.0 - 2.0 * up) - 0.8 * down * down * (3.0 - 2.0 * down));
}

// Millivolts of an ECG a time from its R wave: the waves of McSharry 2003 (IEEE Trans. Biomed. Eng.
// 50, 289), in about their places and sizes.
double heart_wave(double t_s) {
  constexpr double kWaves[][3] = {{-0.17, 0.15, 0.025},
                                  {-0.025, -0.12, 0.010},
                                  {0.0, 1.1, 0.011},
                                  {0.028, -0.22, 0.010},
                                  {0.25, 0.3, 0.045}};
  double sum = 0.0;
  for (const auto& [at_s, height_mv, width_s] : kWaves)
    sum += height_mv * std::exp(-0.5 * std::pow((t_s - at_s) / width_s, 2.0));
  return sum;
}

// Sizes of the low and of the high band of noise while breathing in and out.
struct BreathColour {
  const char* kind;
  double in_low, in_high, out_low, out_high;
};
constexpr BreathColour kColours[] = {{"chest", 0.6, 0.5, 1.0, 0.25},
                                     {"regulator", 0.05, 1.0, 1.0, 0.05},
                                     {"alike", 0.7, 0.7, 0.7, 0.7}};

diver::Recording breath_of(const BreathColour& colour, double bpm, double seconds,
                           const RandomKey& key) {
  diver::Recording out{colour.kind, kMadeSound_hz};
  auto low = diver::SecondOrderFilter::low_pass(400.0, kMadeSound_hz);
  auto high = diver::SecondOrderFilter::high_pass(800.0, kMadeSound_hz);
  double start_s = 0.0, length_s = 60.0 / bpm;
  std::uint64_t breath = 0;
  for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(seconds * kMadeSound_hz); ++i) {
    const double t = static_cast<double>(i) / kMadeSound_hz;
    if (t >= start_s + length_s) {
      start_s += length_s;
      length_s = 60.0 / bpm * (1.0 + 0.05 * random_normal({key.seed, 7, key.frame}, ++breath));
    }
    const double phase = (t - start_s) / length_s;
    const bool in = phase < 0.36, breathes_out = phase >= 0.46 && phase < 0.86;
    const double swell = in             ? std::sin(kPi * phase / 0.36)
                         : breathes_out ? std::sin(kPi * (phase - 0.46) / 0.40)
                                        : 0.0;
    const double noise = random_normal(key, i),
                 hum = 0.05 * random_normal({key.seed, 8, key.frame}, i);
    const double l = low.step(noise), h = high.step(noise);
    out.samples.push_back(0.1 * (swell * ((in ? colour.in_low : colour.out_low) * l +
                                          (in ? colour.in_high : colour.out_high) * h) +
                                 hum));
  }
  return out;
}

double rate_in_name(const std::string& name) {
  const auto end = name.find("bpm");
  if (end == name.npos) return 0.0;
  auto from = end;
  while (from > 0 && name[from - 1] >= '0' && name[from - 1] <= '9') --from;
  int rate = 0;
  std::from_chars(name.data() + from, name.data() + end, rate);
  return rate;
}

}  // namespace

MadeHeart make_heart(double seconds, std::uint64_t seed) {
  MadeHeart out;
  bool pause = false;
  std::uint64_t beat = 0;
  for (double t = 0.4; t < seconds - 0.4; ++beat) {
    const double rate = effort_rate_bpm(t);
    out.beats_s.push_back(t);
    out.rate_bpm.push_back(rate);
    // Breath moves the rate by 4 % at 0.25 Hz; every thirtieth beat comes a third early, and the
    // next as much late.
    double length_s = 60.0 / rate * (1.0 + 0.04 * std::sin(2.0 * kPi * 0.25 * t));
    if (pause)
      length_s *= 1.33;
    else if (random_uniform({seed, 1, 0}, beat) < 1.0 / 30.0)
      length_s *= 0.67;
    pause = !pause && length_s < 0.8 * 60.0 / rate;
    t += length_s;
  }
  return out;
}

std::vector<double> make_ecg(const std::vector<double>& beats_s, double rate_hz, double seconds,
                             double snr_db, std::uint64_t seed) {
  std::vector<double> out(static_cast<std::size_t>(seconds * rate_hz), 0.0);
  for (const double beat_s : beats_s) {
    const auto from = static_cast<std::int64_t>(std::max(0.0, (beat_s - 0.4) * rate_hz));
    const auto to = std::min(static_cast<std::int64_t>((beat_s + 0.5) * rate_hz),
                             static_cast<std::int64_t>(out.size()) - 1);
    for (std::int64_t i = from; i <= to; ++i)
      out[static_cast<std::size_t>(i)] += heart_wave(static_cast<double>(i) / rate_hz - beat_s);
  }
  double power = 0.0;
  for (const double x : out) power += x * x / static_cast<double>(out.size());
  // As much noise a hertz at any rate: that of 360 Hz.
  const double sigma =
      std::sqrt(power * std::pow(10.0, -0.1 * snr_db) * std::max(1.0, rate_hz / 360.0));
  for (std::size_t i = 0; i < out.size(); ++i) out[i] += sigma * random_normal({seed, 2, 0}, i);
  return out;
}

std::vector<BreathSound> make_breath(const std::vector<double>& rates_bpm, double seconds,
                                     std::uint64_t seed) {
  std::vector<BreathSound> out;
  for (const BreathColour& colour : kColours)
    for (const double bpm : rates_bpm)
      out.push_back(
          {colour.kind, bpm,
           breath_of(colour, bpm, seconds, {seed, 3, static_cast<std::uint64_t>(out.size())})});
  return out;
}

Result<std::vector<BreathSound>> read_breath(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> paths;
  std::error_code failed;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder, failed))
    if (entry.path().extension() == ".wav" && rate_in_name(entry.path().filename().string()) > 0.0)
      paths.push_back(entry.path());
  if (failed) return refusal(folder.string(), "no folder", "one with recordings");
  std::ranges::sort(paths);
  std::vector<BreathSound> out;
  for (const auto& path : paths) {
    NERITIC_TRY(const auto bytes, read_file(path));
    NERITIC_TRY(diver::Recording sound, diver::parse_wav(bytes, path.string(), 0));
    NERITIC_TRY_STATUS(diver::check_sound_rate(sound.rate_hz));
    const std::string name = path.filename().string();
    out.push_back({name.substr(0, name.find('_')), rate_in_name(name), std::move(sound)});
  }
  if (out.empty())
    return refusal(folder.string(), "no recordings",
                   ".wav files with names such as breath_12bpm.wav");
  return out;
}

std::vector<diver::BreathFrame> in_pieces(const std::vector<diver::BreathFrame>& frames,
                                          const RandomKey& key) {
  std::vector<std::pair<std::size_t, std::size_t>> pieces;
  std::uint64_t draw = 0;
  for (std::size_t from = 0; from < frames.size(); from = pieces.back().second) {
    const double seconds = 0.3 + 2.7 * random_uniform(key, draw++);
    const auto long_frames = static_cast<std::size_t>(seconds * diver::kBreathFrames_hz);
    pieces.emplace_back(from, std::min(frames.size(), from + long_frames));
  }
  for (std::size_t i = pieces.size(); i > 1; --i)
    std::swap(
        pieces[i - 1],
        pieces[static_cast<std::size_t>(random_uniform(key, draw++) * static_cast<double>(i))]);
  std::vector<diver::BreathFrame> out;
  for (const auto& [from, to] : pieces)
    out.insert(out.end(), frames.begin() + static_cast<std::ptrdiff_t>(from),
               frames.begin() + static_cast<std::ptrdiff_t>(to));
  return out;
}

}  // namespace neritic::tools
