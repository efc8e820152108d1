#include "tools/tradeoff/kind_sweep.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "tools/session/session.hpp"
#include "tools/tradeoff/term_judges.hpp"
#include "tools/tradeoff/term_truth.hpp"

namespace neritic::tools {
namespace {

using scene::Sonar;
using scene::SonarKind;

std::vector<double> scales(bool quick) {
  if (quick) return {0.25, 1.0};
  return {0.18, 0.25, 0.35, 0.5, 0.7, 1.0, 1.4, 2.0};
}

std::vector<std::uint32_t> columns_of(SonarKind kind, bool quick) {
  if (kind == SonarKind::kEchoSounder)
    return quick ? std::vector<std::uint32_t>{32} : std::vector<std::uint32_t>{16, 24, 32, 64, 128};
  return quick ? std::vector<std::uint32_t>{1} : std::vector<std::uint32_t>{1, 2, 3, 4, 6};
}

// Of the middle's.
std::vector<double> row_factors(bool quick) {
  return quick ? std::vector<double>{0.5} : std::vector<double>{0.25, 0.5, 1.0, 2.0, 4.0};
}

std::vector<std::uint32_t> rows_of(const KindSetting& kind, bool quick) {
  std::vector<std::uint32_t> out;
  for (const double factor : row_factors(quick))
    out.push_back(static_cast<std::uint32_t>(kind.middle.rows * factor));
  return out;
}

bool many_beams(SonarKind kind) {
  return kind == SonarKind::kImaging || kind == SonarKind::kProfiling;
}

// Without the point spread: what the cells themselves hold.
Sonar cells_of(Sonar sonar) {
  sonar.terms.beam.azimuth.reset();
  sonar.terms.beam.elevation.reset();
  sonar.terms.range_spread.reset();
  return sonar;
}

struct Measured {
  std::vector<float> image;  // heads and shots one after the other
  double raster_ms = 0.0, gather_ms = 0.0, receive_ms = 0.0;
  double ms() const { return raster_ms + gather_ms + receive_ms; }
};

class KindSweep {
 public:
  KindSweep(const KindSetting& kind, const RayWorld& world, const Pose& place,
            const KindSweepOptions& options)
      : kind_(kind), world_(world), place_(place), options_(options) {}

  Status open(gpu::Device& device, const scene::Scene& scene) {
    scene::Scene own = scene;
    Sonar first = with_knobs(kind_.base, kind_.middle);
    first.terms.level = scene::SonarLevel{};  // so that the session knows what objects scatter
    own.sonars = {first};
    own.cameras.clear();
    NERITIC_TRY(session_, Session::create(device, std::move(own)));
    session_->frames().enable_timing(true);
    return {};
  }

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
    NERITIC_TRY_STATUS(sweep_terms(out));
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
    return fmt::format("bins {} {}", s.bins_range, s.bins_azimuth);
  }

  std::vector<Sonar> other_bins(const Sonar& base) const {
    std::vector<Sonar> out;
    for (const double factor :
         options_.quick ? std::vector<double>{} : std::vector<double>{0.5, 2.0}) {
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

  TruthRays rays() const {
    TruthRays rays;
    const bool narrow = kind_.base.kind == SonarKind::kProfiling;
    const bool cone = kind_.base.kind == SonarKind::kEchoSounder;
    rays.rays = narrow ? 256 : cone ? 1024 : kind_.base.kind == SonarKind::kSideScan ? 8000 : 3000;
    rays.columns_per_step = cone ? 8.0 : narrow ? 8.0 : 4.0;
    rays.columns_per_width = kind_.base.kind == SonarKind::kImaging ? 16.0 : 24.0;
    if (options_.quick) {
      rays.rays /= cone ? 4 : 8;
      rays.columns_per_step = cone ? 4.0 : 1.0;
      rays.columns_per_width = 6.0;
    }
    return rays;
  }

  Status trace() {
    const std::vector<Want> wants = wanted();
    std::vector<Sonar> sonars;
    for (const Want& want : wants) sonars.push_back(want.sonar);
    double off = 0.0, all = 0.0;
    NERITIC_TRY(const Measured poses, render(sonars.front(), 0));
    for (const Placed& placed : placed_) {
      TruthView view;
      view.origin_m = placed.world_from_head.position_m - place_.position_m;
      view.world_from_head = glm::mat3_cast(placed.world_from_head.rotation);
      view.depth_m = -placed.world_from_head.position_m.y;
      view.velocity_m_s = kTrackVelocity_m_s;
      view.yaw_rate_rad_s = kTrackYaw_rad_s * view.world_from_head[1].y;
      NERITIC_TRY(const auto truths, trace_terms(world_, view, sonars, placed.head, rays()));
      for (std::size_t i = 0; i < wants.size(); ++i) {
        std::vector<double>& into = truths_[wants[i].key];
        into.insert(into.end(), truths[i].image.begin(), truths[i].image.end());
      }
      for (std::size_t i = 0; i < truths[0].image.size(); ++i) {
        off += std::abs(truths[0].uncertain[i]);
        all += truths[0].image[i];
      }
      rays_ += truths[0].rays;
    }
    uncertain_ = all > 0.0 ? off / all : 0.0;
    options_.step();
    return {};
  }

  // ---- Pings ----------------------------------------------------------------------------------
  struct Placed {
    Pose world_from_head;
    std::size_t head = 0;
  };

  // Every shot; the least time of repeats (none: only the images), mean over shots.
  Result<Measured> render(const Sonar& sonar, int repeats) {
    Measured out;
    placed_.clear();
    for (const Shot& shot : kind_.shots) {
      Sonar& mine = session_->scene().sonars[0];
      mine = sonar;
      mine.mount = moving_mount(shot.world_from_sonar);
      FrameRequest request;
      request.sonars = {0};
      request.frame = shot.frame;
      request.capture.geometry = false;
      Measured least;
      for (int i = 0; i < repeats + 1; ++i) {
        NERITIC_TRY(const FrameResult frame, session_->render(request));
        if (i == 0) {
          for (const SonarFrame& head : frame.sonars) {
            out.image.insert(out.image.end(), head.image.intensity.begin(),
                             head.image.intensity.end());
            placed_.push_back(
                {head.world_from_head, static_cast<std::size_t>(&head - frame.sonars.data())});
          }
          continue;
        }
        const Measured now = times_of(frame);
        if (i == 1 || now.ms() < least.ms()) least = now;
      }
      const double share = 1.0 / static_cast<double>(kind_.shots.size());
      out.raster_ms += least.raster_ms * share;
      out.gather_ms += least.gather_ms * share;
      out.receive_ms += least.receive_ms * share;
    }
    return out;
  }

  static Measured times_of(const FrameResult& frame) {
    Measured out;
    for (const gpu::PassTime& pass : frame.passes) {
      const auto has = [&](const char* word) { return pass.name.find(word) != std::string::npos; };
      if (pass.name == "record" || has("deform")) continue;  // the scene's, not a sonar's
      if (has("sonar clear") || has("sonar gather"))
        out.gather_ms += pass.ms;
      else if (has("sonar resolve") || has("sonar pulse") || has("sonar beams") ||
               has("sonar receive"))
        out.receive_ms += pass.ms;
      else
        out.raster_ms += pass.ms;
    }
    return out;
  }

  int repeats() const { return options_.quick ? 1 : kind_.shots.size() > 1 ? 3 : 6; }

  // ---- Knobs ----------------------------------------------------------------------------------
  Result<KindPoint> point(const Sonar& base, const std::string& truth, const Knobs& knobs,
                          bool cells) {
    NERITIC_TRY(const Measured found, render(with_knobs(base, knobs), repeats()));
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
      NERITIC_TRY(const Measured bare, render(with_knobs(cells_of(base), knobs), 0));
      const std::string key = truth == "base" ? "cells" : truth + " cells";
      p.error_cells = difference(bare.image, truths_.at(key)).l1;
    }
    return p;
  }

  Status add(KindResult& out, const char* sweep, std::string setting, const Sonar& base,
             const std::string& truth, const Knobs& knobs) {
    NERITIC_TRY(KindPoint p, point(base, truth, knobs, true));
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

  Status sweep_joint(KindResult& out) {
    for (const double scale : scales(options_.quick))
      for (const std::uint32_t columns : columns_of(kind_.base.kind, options_.quick))
        for (const std::uint32_t rows : rows_of(kind_, options_.quick)) {
          // A G-buffer of more than 64 M pixels is no choice of anyone's.
          if (scale > 1.5 && rows > 2 * kind_.middle.rows) continue;
          NERITIC_TRY(KindPoint p,
                      point(kind_.base, "base", {scale, columns, rows, "plane"}, false));
          p.sweep = "joint";
          p.setting = fmt::format("{:g}, {}, {}", scale, columns, rows);
          out.points.push_back(std::move(p));
        }
    options_.step();
    return {};
  }

  // ---- Terms ----------------------------------------------------------------------------------
  Status sweep_terms(KindResult& out) {
    for (const TermCase& c : cases_) {
      using Judge = TermCase::Judge;
      Sonar changed = c.with;
      if (c.judge == Judge::kNoise) changed.terms.noise->level_db = a_tenth_db(c);
      NERITIC_TRY(const Measured with, render(changed, repeats()));
      NERITIC_TRY(const Measured without, render(c.without, repeats()));
      TermPoint p;
      p.term = c.name;
      p.ms = with.ms() - without.ms();
      if (c.judge == Judge::kImage || c.judge == Judge::kShape) {
        const auto& truth = truths_.at(c.name);
        p.error_with = difference(with.image, truth).l1;
        p.error_without = difference(without.image, truth, c.judge == Judge::kShape).l1;
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
    return sweep_scatterers(out);
  }

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
    const std::uint64_t seed = session_->scene().seed;
    Sonar without = sonar;
    without.terms.speckle.reset();
    NERITIC_TRY(const Measured smooth, render(without, 0));
    SpeckleMoments moments;
    for (std::uint64_t draw = 0; draw < (options_.quick ? 1u : 4u); ++draw) {
      session_->scene().seed = seed + draw;
      NERITIC_TRY(const Measured found, render(sonar, 0));
      moments.add(found.image, smooth.image);
    }
    session_->scene().seed = seed;
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
      NERITIC_TRY(const Measured timed, render(s, repeats()));
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
  const RayWorld& world_;
  Pose place_;
  const KindSweepOptions& options_;
  std::unique_ptr<Session> session_;
  std::vector<TermCase> cases_;
  std::vector<Placed> placed_;
  std::map<std::string, std::vector<double>> truths_;
  double uncertain_ = 0.0, rays_ = 0.0;
};

}  // namespace

std::uint64_t kind_steps(SonarKind kind, bool quick) {
  const std::uint64_t bins = quick ? 0 : many_beams(kind) ? 3 : 2;
  const std::uint64_t terms = kind == SonarKind::kEchoSounder ? 12 : 13;  // of term_cases
  // The rays; gathers; terms and scatterers; the joint sweep.
  return 1 + scales(quick).size() + 2 + columns_of(kind, quick).size() + row_factors(quick).size() +
         bins + terms + 1 + 1;
}

Result<KindResult> sweep_kind(gpu::Device& device, const scene::Scene& scene, const RayWorld& world,
                              const KindSetting& kind, const KindSweepOptions& options) {
  KindSweep sweep(kind, world, place_of(scene), options);
  NERITIC_TRY_STATUS(sweep.open(device, scene));
  return sweep.run();
}

const KindPoint* cheapest(const KindResult& result, double max_error) {
  const KindPoint* best = nullptr;
  for (const KindPoint& p : result.points)
    if (p.sweep == "joint" && p.error <= max_error && (!best || p.ms() < best->ms())) best = &p;
  return best;
}

}  // namespace neritic::tools
