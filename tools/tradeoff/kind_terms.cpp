#include "tools/tradeoff/kind_terms.hpp"

#include <cmath>

#include "tools/tradeoff/host_terms.hpp"
#include "tools/tradeoff/term_judges.hpp"

namespace neritic::tools {
namespace {

using scene::Sonar;
using scene::SonarKind;
using MeasuredTerm = KindBench::Measured;

// Pairs of pings by which a term's cost is measured.
constexpr int kPairs = 11;
// A term that changes the image by less than this is not heard in it.
constexpr double kUnheard = 1e-4;

// Inputs that the rays share with the sonar, so that the comparison cannot check them.
const char* taken_by_the_rays(const scene::SonarTerms& terms) {
  if (terms.ghosts) return "the rays take the mirrors' places as given";
  if (terms.profile && terms.profile->bent) return "the rays take the bent rays' table as given";
  return "";
}

class TermSweep {
 public:
  explicit TermSweep(const TermSweepInputs& in)
      : kind_(in.kind),
        bench_(in.bench),
        options_(in.options),
        cases_(in.cases),
        truths_(in.truths),
        repeats_(in.repeats) {}

  Status run(KindResult& out) {
    for (const TermCase& c : cases_) {
      using Judge = TermCase::Judge;
      Sonar changed = c.with;
      if (c.judge == Judge::kNoise) changed.terms.noise->level_db = a_tenth_db(c);
      NERITIC_TRY(const MeasuredTerm with, bench_.render(changed, 0));
      NERITIC_TRY(const MeasuredTerm without, bench_.render(c.without, 0));
      NERITIC_TRY(const KindBench::Price price,
                  bench_.price(changed, c.without, options_.quick ? 3 : kPairs));
      TermPoint p;
      p.term = c.name;
      p.ms = price.ms;
      p.resolution_ms = price.resolution_ms;
      if (c.judge == Judge::kImage || c.judge == Judge::kShape) {
        const auto& truth = truths_.at(c.name);
        p.error_with = difference(with.image, truth).l1;
        p.error_without = difference(without.image, truth, c.judge == Judge::kShape).l1;
        const std::vector<double> before(without.image.begin(), without.image.end());
        p.note = difference(with.image, before).l1 < kUnheard
                     ? "nothing of it is heard here: the image is the same without"
                     : taken_by_the_rays(c.with.terms);
      } else if (c.judge == Judge::kSpeckle) {
        NERITIC_TRY_STATUS(judge_speckle(c, p));
      } else if (c.judge == Judge::kNoise) {
        const auto& clean = truths_.at(c.name);
        const NoiseFound n = judge_noise(with.image, clean, kind_.base, changed);
        if (n.cells > 0) p.error_with = std::abs(n.mean_over_expected - 1.0);
        p.error_without = n.share;
        p.note = fmt::format("mean {:.3f} of the level named over {} silent cells",
                             n.mean_over_expected, n.cells);
      }
      out.terms.push_back(std::move(p));
      options_.step();
    }
    NERITIC_TRY_STATUS(sweep_scatterers(out));
    return add_host_terms(out);
  }

  // Terms that do not depend on the kind are reported with the first kind only.
  Status add_host_terms(KindResult& out) {
    if (kind_.base.kind != SonarKind::kImaging) return {};
    for (const TermCase& c : cases_) {
      if (c.name == "profile, bent")
        for (TermPoint& p :
             profile_tables(c.with, -kind_.shots.front().world_from_sonar.position_m.y))
          out.terms.push_back(std::move(p));
      if (c.name != "level") continue;
      NERITIC_TRY(const MeasuredTerm level, bench_.render(c.with, 0));
      for (TermPoint& p : counts_of(level.image)) out.terms.push_back(std::move(p));
    }
    return {};
  }

 private:
  // The noise level whose power, in all cells together, is a tenth of the echoes'.
  double a_tenth_db(const TermCase& c) const {
    const auto& clean = truths_.at(c.name);
    Sonar unit = c.with;
    unit.terms.noise->level_db = 0.0;
    const double share =
        judge_noise(std::vector<float>(clean.size()), clean, kind_.base, unit).share;
    return 10.0 * std::log10(0.1 * (1.0 - share) / share);
  }

  // Over draws of the world's scatterers.
  Result<SpeckleFound> speckle_of(Sonar sonar) {
    Sonar without = sonar;
    without.terms.speckle.reset();
    NERITIC_TRY(const MeasuredTerm smooth, bench_.render(without, 0));
    SpeckleMoments moments;
    for (std::uint64_t draw = 0; draw < (options_.quick ? 1u : 4u); ++draw) {
      NERITIC_TRY(const MeasuredTerm found, bench_.render(sonar, 0, draw));
      moments.add(found.image, smooth.image);
    }
    return moments.found();
  }

  Status judge_speckle(const TermCase& c, TermPoint& p) {
    NERITIC_TRY(const SpeckleFound s, speckle_of(c.with));
    p.error_with = std::abs(s.contrast / kRayleighContrast - 1.0);
    p.error_without = s.departure;
    p.note =
        fmt::format("contrast {:.3f} (Rayleigh {:.3f}), mean power {:.3f} of what it is without",
                    s.contrast, kRayleighContrast, s.mean);
    return {};
  }

  Status sweep_scatterers(KindResult& out) {
    for (const double steps : options_.quick ? std::vector<double>{1.0}
                                             : std::vector<double>{0.25, 0.5, 1.0, 2.0, 4.0}) {
      Sonar s = with_knobs(kind_.base, kind_.middle);
      const double step_m = (s.range_max_m - s.range_min_m) / s.bins_range;
      s.terms.speckle = scene::SonarSpeckle{.scatterer_m = steps * step_m};
      NERITIC_TRY(const MeasuredTerm timed, bench_.render(s, repeats_));
      NERITIC_TRY(const SpeckleFound found, speckle_of(s));
      TermPoint p;
      p.term = fmt::format("speckle, scatterers of {:g} range steps", steps);
      p.ms = timed.ms();
      p.error_with = std::abs(found.contrast / kRayleighContrast - 1.0);
      p.note = fmt::format("contrast {:.3f}, mean power {:.3f}; ms of the whole ping",
                           found.contrast, found.mean);
      out.terms.push_back(std::move(p));
    }
    options_.step();
    return {};
  }

  const KindSetting& kind_;
  KindBench& bench_;
  const KindSweepOptions& options_;
  const std::vector<TermCase>& cases_;
  const std::map<std::string, std::vector<double>>& truths_;
  int repeats_;
};

}  // namespace

Status sweep_terms(const TermSweepInputs& inputs, KindResult& out) {
  return TermSweep(inputs).run(out);
}

}  // namespace neritic::tools
