#include "tools/tradeoff/term_judges.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/core/check.hpp"
#include "sonar/acoustics.hpp"
#include "sonar/levels.hpp"

namespace neritic::tools {

ImageDifference difference(std::span<const float> image, std::span<const double> truth,
                           bool scaled) {
  NERITIC_CHECK(image.size() == truth.size(), "{} cells against {}", image.size(), truth.size());
  const double all = std::accumulate(truth.begin(), truth.end(), 0.0);
  const double found = std::accumulate(image.begin(), image.end(), 0.0);
  if (!(all > 0.0)) return {};
  const double factor = scaled && found > 0.0 ? all / found : 1.0;
  double l1 = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) l1 += std::abs(factor * image[i] - truth[i]);
  return {l1 / all, found / all - 1.0};
}

void SpeckleMoments::add(std::span<const float> image, std::span<const float> smooth) {
  NERITIC_CHECK(image.size() == smooth.size(), "{} cells against {}", image.size(), smooth.size());
  const double least = 1e-3 * *std::max_element(smooth.begin(), smooth.end());
  for (std::size_t i = 0; i < smooth.size(); ++i) {
    if (!(smooth[i] > least)) continue;
    const double x = image[i] / smooth[i];
    n_ += 1.0;
    power_ += x;
    amplitude_ += std::sqrt(x);
    departure_ += std::abs(x - 1.0);
  }
}

SpeckleFound SpeckleMoments::found() const {
  if (!(n_ > 0.0)) return {};
  const double power = power_ / n_, amplitude = amplitude_ / n_;
  return {std::sqrt(std::max(0.0, power - amplitude * amplitude)) / amplitude, power,
          departure_ / n_};
}

NoiseFound judge_noise(std::span<const float> image, std::span<const double> clean,
                       const scene::Sonar& grid, const scene::Sonar& terms) {
  NERITIC_CHECK(terms.terms.noise && terms.terms.level, "a sensor with noise and level");
  const double power = sonar::power_from_db(sonar::noise_level_db(terms.terms));
  const double step = (grid.range_max_m - grid.range_min_m) / grid.bins_range;
  const std::size_t beams =
      grid.kind == scene::SonarKind::kImaging || grid.kind == scene::SonarKind::kProfiling
          ? grid.bins_azimuth
          : 1;
  NoiseFound out;
  double expected = 0.0, found = 0.0, all = 0.0, noise = 0.0;
  for (std::size_t i = 0; i < image.size(); ++i) {
    const std::size_t row = i / beams % grid.bins_range;
    const double r = grid.range_min_m + (static_cast<double>(row) + 0.5) * step;
    const double gain_db = terms.terms.level->gain_db + terms.terms.level->tvg_log * std::log10(r);
    const double here = power * std::pow(10.0, gain_db / 10.0);
    all += clean[i];
    noise += here;
    if (clean[i] > 1e-3 * here) continue;
    ++out.cells;
    expected += here;
    found += image[i];
  }
  out.mean_over_expected = expected > 0.0 ? found / expected : 0.0;
  out.share = noise / (noise + all);
  return out;
}

}  // namespace neritic::tools
