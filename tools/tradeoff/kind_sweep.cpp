#include "tools/tradeoff/kind_sweep.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "tools/tradeoff/joint_search.hpp"
#include "tools/tradeoff/kind_bench.hpp"
#include "tools/tradeoff/kind_terms.hpp"
#include "tools/tradeoff/kind_truth.hpp"
#include "tools/tradeoff/term_judges.hpp"

namespace neritic::tools {
namespace {

using scene::Sonar;
using scene::SonarKind;
using Measured = KindBench::Measured;

std::vector<double> scales(bool quick) {
  if (quick) return {0.25, 1.0};
  return {0.18, 0.25, 0.35, 0.5, 0.7, 1.0, 1.4, 2.0};
}

bool many_beams(SonarKind kind) {
  return kind == SonarKind::kImaging || kind == SonarKind::kProfiling;
}

std::vector<std::uint32_t> columns_of(SonarKind kind, bool quick) {
  if (kind == SonarKind::kEchoSounder)
    return quick ? std::vector<std::uint32_t>{32} : std::vector<std::uint32_t>{16, 24, 32, 64, 128};
  if (quick) return {1};
  if (many_beams(kind)) return {1, 2, 3, 4, 6};
  return {1, 2, 4, 6, 10, 16};
}

// Factors of the middle setting's number of rows.
std::vector<double> row_factors(bool quick) {
  return quick ? std::vector<double>{0.5}
               : std::vector<double>{0.0625, 0.125, 0.25, 0.5, 1.0, 2.0, 4.0};
}

std::vector<std::uint32_t> rows_of(const KindSetting& kind, bool quick) {
  std::vector<std::uint32_t> out;
  for (const double factor : row_factors(quick))
    out.push_back(std::max(1u, static_cast<std::uint32_t>(kind.middle.rows * factor)));
  return out;
}

// Without the point spread: what the cells themselves hold.
Sonar cells_of(Sonar sonar) {
  sonar.terms.beam.azimuth.reset();
  sonar.terms.beam.elevation.reset();
  sonar.terms.range_spread.reset();
  return sonar;
}

class KindSweep {
 public:
  KindSweep(const KindSetting& kind, KindBench& bench, const RayWorld& world, const Pose& place,
            const KindSweepOptions& options)
      : kind_(kind), bench_(bench), world_(world), place_(place), options_(options) {}

  Result<KindResult> run() {
    KindResult out;
    out.kind = scene::name_of(kind_.base.kind);
    out.base = kind_.base;
    out.middle = kind_.middle;
    cases_ = term_cases(kind_);
    NERITIC_TRY_STATUS(trace());
    out.uncertain = uncertain_;
    out.rays = rays_;
    NERITIC_TRY_STATUS(sweep_knobs(out));
    NERITIC_TRY_STATUS(sweep_terms({kind_, bench_, options_, cases_, truths_, repeats()}, out));
    NERITIC_TRY_STATUS(sweep_joint(out));
    return out;
  }

 private:
  // ---- The rays' images: base, cells, other bins, each term -----------------------------------
  struct Want {
    Sonar sonar;
    std::string key;
  };

  std::vector<Want> wanted() const {
    const Sonar base = with_knobs(kind_.base, kind_.middle);
    std::vector<Want> out{{base, "base"}, {cells_of(base), "cells"}};
    for (const Sonar& s : other_bins(base)) {
      out.push_back({s, key_of_bins(s)});
      out.push_back({cells_of(s), key_of_bins(s) + " cells"});
    }
    for (const TermCase& c : cases_)
      if (c.judge == TermCase::Judge::kImage || c.judge == TermCase::Judge::kShape ||
          c.judge == TermCase::Judge::kNoise) {
        Sonar clean = c.with;
        clean.terms.noise.reset();
        out.push_back({clean, c.name});
      }
    return out;
  }

  static std::string key_of_bins(const Sonar& s) {
    return fmt::format("bins {} {}", s.bins_range, many_beams(s.kind) ? s.bins_azimuth : 1);
  }

  std::vector<Sonar> other_bins(const Sonar& base) const {
    std::vector<Sonar> out;
    for (const double factor :
         options_.quick ? std::vector<double>{} : std::vector<double>{0.5, 2.0, 4.0}) {
      Sonar s = base;
      s.bins_range = static_cast<std::uint32_t>(s.bins_range * factor);
      out.push_back(s);
    }
    if (many_beams(base.kind) && !options_.quick) {
      Sonar s = base;
      s.bins_azimuth /= 2;
      out.push_back(s);
    }
    return out;
  }

  // Enough rays for their own error to be a fraction of a per cent (KindResult::uncertain).
  TruthRays rays() const {
    TruthRays rays;
    switch (kind_.base.kind) {
      case SonarKind::kImaging:
        rays = {6.0, 24.0, 5000};
        break;
      case SonarKind::kProfiling:
        rays = {8.0, 24.0, 256};
        break;
      case SonarKind::kEchoSounder:
        rays = {8.0, 24.0, 1024};
        break;
      case SonarKind::kSideScan:
      case SonarKind::kMechanical:
        rays = {32.0, 32.0, 16000};
        break;
    }
    if (!options_.quick) return rays;
    return {1.0, 6.0, std::max(64u, rays.rays / 16)};
  }

  Status trace() {
    const std::vector<Want> wants = wanted();
    std::vector<Sonar> sonars;
    for (const Want& want : wants) sonars.push_back(want.sonar);
    NERITIC_TRY(const Measured poses, bench_.render(sonars.front(), 0));
    say(fmt::format("{} images by rays", wants.size()));
    NERITIC_TRY(KindTruth truth,
                trace_kind(world_, place_.position_m, bench_.placed(), sonars, rays()));
    for (std::size_t i = 0; i < wants.size(); ++i)
      truths_[wants[i].key] = std::move(truth.images[i]);
    uncertain_ = truth.uncertain;
    rays_ = truth.rays;
    options_.step();
    return {};
  }

  void say(const std::string& what) const {
    options_.now(fmt::format("{}, {}", scene::name_of(kind_.base.kind), what));
  }
  int repeats() const { return options_.quick ? 1 : kind_.shots.size() > 1 ? 3 : 6; }

  // ---- Knobs ----------------------------------------------------------------------------------
  Result<KindPoint> point(const Sonar& base, const std::string& truth, const Knobs& knobs,
                          bool cells, int repeats) {
    NERITIC_TRY(const Measured found, bench_.render(with_knobs(base, knobs), repeats));
    KindPoint p;
    p.knobs = knobs;
    p.bins_range = base.bins_range;
    p.beams = base.bins_azimuth;
    const ImageDifference d = difference(found.image, truths_.at(truth));
    p.error = d.l1;
    p.energy = d.energy;
    p.raster_ms = found.raster_ms;
    p.gather_ms = found.gather_ms;
    p.receive_ms = found.receive_ms;
    if (cells) {
      NERITIC_TRY(const Measured bare, bench_.render(with_knobs(cells_of(base), knobs), 0));
      const std::string key = truth == "base" ? "cells" : truth + " cells";
      p.error_cells = difference(bare.image, truths_.at(key)).l1;
    }
    return p;
  }

  Status add(KindResult& out, const char* sweep, std::string setting, const Sonar& base,
             const std::string& truth, const Knobs& knobs) {
    say(fmt::format("{} {}", sweep, setting));
    NERITIC_TRY(KindPoint p, point(base, truth, knobs, true, repeats()));
    p.sweep = sweep;
    p.setting = std::move(setting);
    out.points.push_back(std::move(p));
    options_.step();
    return {};
  }

  Status sweep_knobs(KindResult& out) {
    const Sonar& base = kind_.base;
    for (const double scale : scales(options_.quick)) {
      Knobs k = kind_.middle;
      k.scale = scale;
      NERITIC_TRY_STATUS(add(out, "gbuffer_scale", fmt::format("{:g}", scale), base, "base", k));
    }
    for (const char* gather : {"plane", "nearest"}) {
      Knobs k = kind_.middle;
      k.gather = gather;
      NERITIC_TRY_STATUS(add(out, "gather", gather, base, "base", k));
    }
    for (const std::uint32_t columns : columns_of(kind_.base.kind, options_.quick)) {
      Knobs k = kind_.middle;
      k.columns = columns;
      NERITIC_TRY_STATUS(add(out, "columns", fmt::format("{}", columns), base, "base", k));
    }
    for (const std::uint32_t rows : rows_of(kind_, options_.quick)) {
      Knobs k = kind_.middle;
      k.rows = rows;
      NERITIC_TRY_STATUS(add(out, "rows", fmt::format("{}", rows), base, "base", k));
    }
    for (const Sonar& s : other_bins(base)) {
      const bool ranges = s.bins_range != base.bins_range;
      NERITIC_TRY_STATUS(add(out, ranges ? "range bins" : "beams",
                             fmt::format("{}", ranges ? s.bins_range : s.bins_azimuth), s,
                             key_of_bins(s), kind_.middle));
    }
    return {};
  }

  // ---- All knobs together ---------------------------------------------------------------------
  Ladders ladders() const {
    const std::uint32_t bins = kind_.base.bins_range;
    Ladders out{
        {bins}, {}, columns_of(kind_.base.kind, options_.quick), rows_of(kind_, options_.quick)};
    if (!options_.quick) out.bins = {bins / 2, bins, 2 * bins, 4 * bins};
    for (const double scale : scales(options_.quick))
      if (scale < 1.5) out.scales.push_back(scale);  // beyond, images are of 64 M pixels
    if (kind_.base.kind != SonarKind::kImaging || options_.quick) return out;
    // All beams and rows of the finest would keep two cores for a minute a ping.
    out.bins.pop_back();
    out.scales.pop_back();
    out.rows.pop_back();
    return out;
  }

  Result<KindPoint> measure(const Knobs& knobs, int repeats) {
    Sonar sonar = kind_.base;
    sonar.bins_range = knobs.bins_range;
    const bool own = sonar.bins_range == kind_.base.bins_range;
    NERITIC_TRY(KindPoint p,
                point(sonar, own ? "base" : key_of_bins(sonar), knobs, false, repeats));
    p.sweep = "joint";
    p.setting =
        fmt::format("{:g}, {}, {}, {}", knobs.scale, knobs.columns, knobs.rows, knobs.bins_range);
    return p;
  }

  Status sweep_joint(KindResult& out) {
    int tried = 0;
    const auto measured = [&](const Knobs& knobs, int times) {
      say(fmt::format("search for the levels, setting {}", ++tried));
      return measure(knobs, times);
    };
    NERITIC_TRY(const auto found, search_joint(ladders(), measured, repeats()));
    out.points.insert(out.points.end(), found.begin(), found.end());
    options_.step();
    return {};
  }

  const KindSetting& kind_;
  KindBench& bench_;
  const RayWorld& world_;
  Pose place_;
  const KindSweepOptions& options_;
  std::vector<TermCase> cases_;
  std::map<std::string, std::vector<double>> truths_;
  double uncertain_ = 0.0, rays_ = 0.0;
};

}  // namespace

std::uint64_t kind_steps(SonarKind kind, bool quick) {
  const std::uint64_t bins = quick ? 0 : many_beams(kind) ? 4 : 3;
  const std::uint64_t terms = kind == SonarKind::kEchoSounder ? 12 : 13;  // of term_cases
  // The rays; gathers; terms and scatterers; the joint sweep.
  return 1 + scales(quick).size() + 2 + columns_of(kind, quick).size() + row_factors(quick).size() +
         bins + terms + 1 + 1;
}

Result<KindResult> sweep_kind(gpu::Device& device, const scene::Scene& scene, const RayWorld& world,
                              const KindSetting& kind, const KindSweepOptions& options) {
  KindBench bench(kind);
  NERITIC_TRY_STATUS(bench.open(device, scene));
  return KindSweep(kind, bench, world, place_of(scene), options).run();
}

const KindPoint* cheapest(const KindResult& result, double max_error) {
  const KindPoint* best = nullptr;
  for (const KindPoint& p : result.points)
    if (p.sweep == "joint" && p.error <= max_error && (!best || p.ms() < best->ms())) best = &p;
  return best;
}

}  // namespace neritic::tools
