#include "tools/tradeoff/term_truth.hpp"

#include <algorithm>
#include <cmath>
#include <thread>

#include "sonar/ping.hpp"
#include "sonar/range_correction.hpp"

namespace neritic::tools {
namespace {

struct Column {
  double azimuth_rad, width_rad;
  bool fine;
  int half;  // neighbours lie in different halves, so that what those differ by is the rays' error
};

// Columns outside the aperture are wider by this factor, since the pattern is weak there.
constexpr int kCoarser = 8;
// Half-power widths around the aperture that are still traced finely.
constexpr double kFineWidths = 4.0;

std::vector<Column> columns_of(const sonar::BeamGrid& grid, const scene::Sonar& sonar, bool folded,
                               const TruthRays& rays) {
  const double step = grid.azimuth_step_rad();
  const bool wide = sonar.terms.beam.azimuth.has_value() && !folded;
  const double half_power = wide ? sonar.terms.beam.azimuth->half_power_rad : step;
  double wanted = step / rays.columns_per_step;
  if (wide) wanted = std::min(wanted, half_power / rays.columns_per_width);
  const double span = grid.limits.azimuth_max_rad - grid.limits.azimuth_min_rad;
  const auto inside = static_cast<int>(std::ceil(span / wanted - 1e-9));
  // A whole number of columns a step, so that none lies across two beams.
  const int a_step = std::max(1, static_cast<int>(std::ceil(double(inside) / grid.bins.azimuth)));
  const double width = step / a_step;
  const int columns = a_step * static_cast<int>(grid.bins.azimuth);
  std::vector<Column> out;
  for (int i = 0; i < columns; ++i)
    out.push_back({grid.limits.azimuth_min_rad + (i + 0.5) * width, width, true, i % 2});
  if (!wide) return out;
  const double room = std::min(kPi / 2.0, (2.0 * kPi - span) / 2.0);
  const double fine = std::min(room, kFineWidths * half_power);
  for (const double side : {-1.0, 1.0}) {
    const double edge = side < 0.0 ? grid.limits.azimuth_min_rad : grid.limits.azimuth_max_rad;
    double from = 0.0;
    int half = side < 0.0 ? 1 : columns % 2;
    const auto fill = [&](double to, double w, bool is_fine) {
      const auto n = static_cast<int>(std::ceil((to - from) / w - 1e-9));
      for (int i = 0; i < n; ++i) {
        out.push_back(
            {edge + side * (from + (i + 0.5) * (to - from) / n), (to - from) / n, is_fine, half});
        half = 1 - half;
      }
      from = to;
    };
    fill(fine, width, true);
    fill(room, width * kCoarser, false);
  }
  return out;
}

// The part of a number behind its whole part, exact; it takes less time than std::fmod.
double fraction(double x) {
  return x - std::floor(x);
}

class Tracer {
 public:
  Tracer(const RayWorld& world, const TruthView& view, const sonar::Head& head,
         const sonar::HeadPatterns& patterns, const std::vector<sonar::Mirror>& mirrors,
         std::vector<TermImage>& images)
      : world_(world),
        view_(view),
        head_(head),
        patterns_(patterns),
        mirrors_(mirrors),
        images_(images) {
    for (const TermImage& image : images) {
      finest_m_ = std::min(finest_m_, image.grid().range_step_m());
      const auto& profile = image.settings().terms.profile;
      if (profile && profile->bent)
        most_bend_rad_ = std::max(most_bend_rad_,
                                  sonar::most_bend_rad(*profile, image.grid().limits.range_max_m));
    }
  }
  std::uint64_t cast() const { return cast_; }

  void trace(const Column& column, int index, std::uint32_t rays) {
    for (TermImage& image : images_) image.begin_column(column.azimuth_rad, column.width_rad);
    const sonar::Limits& l = head_.samples.limits;
    const double width = (l.elevation_max_rad - l.elevation_min_rad) / rays;
    // Each column's rays lie at other elevations, by the golden ratio, so that neighbours fill
    // each other's gaps; and each ray at another place of the column's width, by 1 / 1.3247..., so
    // that an upright edge is met by as many rays as it should be.
    const double offset = fraction((index + 1) * 0.6180339887498949);
    for (std::uint32_t i = 0; i < rays; ++i)
      stratum(column, l.elevation_min_rad + i * width, width, offset);
    for (TermImage& image : images_) image.end_column(column.half);
  }

 private:
  // One ray for a piece of elevation, or, where that spans many bins of range (a floor far away),
  // one for each half a bin of it.
  void stratum(const Column& column, double from_rad, double width_rad, double offset) {
    const TruthRay ray = ray_at(column, from_rad + offset * width_rad, width_rad, offset);
    const RayHit hit = hit_of(ray);
    const int pieces = pieces_of(ray, hit);
    if (pieces == 1) return add(ray, hit);
    for (int k = 0; k < pieces; ++k) {
      const double part_rad = width_rad / pieces;
      const TruthRay finer = ray_at(column, from_rad + (k + offset) * part_rad, part_rad, offset);
      add(finer, hit_of(finer));
    }
  }

  TruthRay ray_at(const Column& column, double elevation_rad, double width_rad, double offset) {
    TruthRay ray;
    ray.elevation_rad = elevation_rad;
    ray.elevation_width_rad = width_rad;
    const double place = fraction(offset + static_cast<double>(cast_) * 0.7548776662466927);
    const double azimuth_rad = column.azimuth_rad + (place - 0.5) * column.width_rad;
    const Vec3 d = sonar::direction(azimuth_rad, elevation_rad);
    ray.off_axis_rad = std::acos(std::clamp(-d.z, -1.0, 1.0));
    ray.inside = head_.folded ? ray.off_axis_rad <= patterns_.cone_rad
                              : std::abs(elevation_rad) <= head_.heard_up_rad;
    ray.direction = view_.world_from_head * d;
    ray.pattern = patterns_.power(azimuth_rad, elevation_rad);
    ++cast_;
    return ray;
  }

  RayHit hit_of(const TruthRay& ray) const {
    return is_cast(ray) ? world_.cast_from(view_.origin_m, ray.direction) : RayHit{};
  }

  // A ray that leaves within the cone can end beyond it, since rays bend.
  bool is_cast(const TruthRay& ray) const {
    return !head_.folded || ray.off_axis_rad <= patterns_.cone_rad + most_bend_rad_;
  }

  // An image's pattern weighs a bent ray at the angle at which it leaves, not at which it ends. The
  // piece of elevation that the ray stands for stays that of its direction.
  TruthRay leaving(const TermImage& image, const TruthRay& ray, double range_m, bool ghost) const {
    const double bend_rad = image.bend_rad(range_m, ray.direction.y, ghost);
    const Vec3 level(ray.direction.x, 0.0, ray.direction.z);
    const double cosine = glm::length(level);
    if (bend_rad == 0.0 || cosine < 1e-9) return seen_by(image, ray);
    const double up_rad = std::atan2(ray.direction.y, cosine) + bend_rad;
    const Vec3 leaves = level * (std::cos(up_rad) / cosine) + Vec3(0, std::sin(up_rad), 0);
    TruthRay out = seen_by(image, towards(ray, leaves));
    out.elevation_rad = ray.elevation_rad;
    return out;
  }

  // The same ray with the place in the patterns of another direction of the world.
  TruthRay towards(const TruthRay& ray, const Vec3& direction) const {
    const Vec3 d = glm::transpose(view_.world_from_head) * direction;
    TruthRay out = ray;
    out.elevation_rad = std::asin(std::clamp(d.y, -1.0, 1.0));
    out.off_axis_rad = std::acos(std::clamp(-d.z, -1.0, 1.0));
    out.inside = head_.folded ? out.off_axis_rad <= patterns_.cone_rad
                              : std::abs(out.elevation_rad) <= head_.heard_up_rad;
    out.pattern = patterns_.power(std::atan2(d.x, -d.z), out.elevation_rad);
    return out;
  }

  int pieces_of(const TruthRay& ray, const RayHit& hit) const {
    if (!(hit.t > 0.0)) return 1;
    constexpr double kMost = 32.0, kLeastCosine = 1e-3;
    const double cosine =
        std::clamp(std::abs(glm::dot(Vec3(hit.normal), ray.direction)), kLeastCosine, 1.0);
    const double span_m =
        ray.elevation_width_rad * hit.t * std::sqrt(1.0 - cosine * cosine) / cosine;
    return static_cast<int>(std::clamp(std::ceil(span_m / (0.5 * finest_m_)), 1.0, kMost));
  }

  // Applies a ray's pattern only if the image's settings name one (of a cone, either).
  static TruthRay seen_by(const TermImage& image, const TruthRay& ray) {
    const scene::Sonar& sonar = image.settings();
    const bool cone = sonar.kind == scene::SonarKind::kEchoSounder;
    const bool named = sonar.terms.beam.elevation || (cone && sonar.terms.beam.azimuth);
    TruthRay out = ray;
    if (!named) {
      // Without a pattern an image hears its aperture and no more.
      out.pattern = 1.0;
      const double half_rad = cone ? sonar.semi_angle_rad : 0.5 * sonar.elevation_rad;
      const double off_rad = cone ? ray.off_axis_rad : std::abs(ray.elevation_rad);
      out.inside = ray.inside && off_rad <= half_rad;
    }
    return out;
  }

  void add(const TruthRay& ray, const RayHit& hit) {
    if (!is_cast(ray)) return;
    TruthEcho echo;
    if (hit.t > 0.0) {
      echo.out_m = echo.back_m = hit.t;
      echo.target_m = ray.direction * hit.t;
      echo.cosine = -glm::dot(Vec3(hit.normal), ray.direction);
      echo.reflectivity = hit.reflectivity;
      echo.backscatter = hit.backscatter;
    }
    for (TermImage& image : images_) {
      image.add_solid_angle(seen_by(image, ray));
      if (!(hit.t > 0.0)) continue;
      if (image.profile()) echo.seconds = 2.0 * leg_s(*image.profile(), Vec3(0.0), echo.target_m);
      image.add(leaving(image, ray, hit.t, false), echo);
    }
    for (const sonar::Mirror& mirror : mirrors_) bounce(ray, hit, mirror);
  }

  // Along a straight leg, points from the sonar.
  double leg_s(const sonar::SoundSpeedProfile& profile, const Vec3& from, const Vec3& to) const {
    const Vec3 way = to - from;
    const double length = glm::length(way);
    return profile.straight_time_s(view_.depth_m - from.y,
                                   std::asin(std::clamp(way.y / length, -1.0, 1.0)), length);
  }

  void bounce(const TruthRay& ray, const RayHit& direct, const sonar::Mirror& mirror) {
    const double above_m = mirror.height_m + view_.depth_m;  // of the mirror over the sonar
    const double leg_m = ray.direction.y != 0.0 ? above_m / ray.direction.y : 0.0;
    if (!(leg_m > 0.0) || (direct.t > 0.0 && direct.t < leg_m)) return;
    const Vec3 at = ray.direction * leg_m;
    const Vec3 onward(ray.direction.x, -ray.direction.y, ray.direction.z);
    const RayHit hit = world_.cast_from(view_.origin_m + at, onward);
    if (!(hit.t > 0.0)) return;
    TruthEcho echo;
    echo.ghost = true;
    echo.target_m = at + onward * hit.t;
    echo.out_m = leg_m + hit.t;
    echo.back_m = glm::length(echo.target_m);
    const Vec3 back = -echo.target_m / echo.back_m;
    echo.cosine = glm::dot(Vec3(hit.normal), back);
    if (!(echo.cosine > 0.0)) return;
    // Is the way back free? From just above the surface that was hit.
    const Vec3 start = echo.target_m + Vec3(hit.normal) * 1e-3;
    const RayHit between = world_.cast_from(view_.origin_m + start, back);
    if (between.t > 0.0 && between.t < echo.back_m - 2e-3) return;
    echo.reflectivity = hit.reflectivity;
    echo.backscatter = hit.backscatter;
    // Both reciprocal paths add in amplitude.
    echo.bounce = sonar::kGhostPaths * sonar::kGhostPaths * mirror.reflection * mirror.reflection;
    for (TermImage& image : images_) {
      if (!image.wants_ghosts()) continue;
      if (image.profile())
        echo.seconds = leg_s(*image.profile(), Vec3(0.0), at) +
                       leg_s(*image.profile(), at, echo.target_m) +
                       leg_s(*image.profile(), echo.target_m, Vec3(0.0));
      image.add(both_legs(image, ray, echo, -back), echo);
    }
  }

  // A ghost passes the pattern once along either leg, and hears nothing along a leg beyond it.
  TruthRay both_legs(const TermImage& image, const TruthRay& mirrored, const TruthEcho& echo,
                     const Vec3& direct) const {
    TruthRay other = towards(mirrored, direct);
    other.direction = direct;
    TruthRay out = leaving(image, mirrored, echo.out_m, true);
    other = leaving(image, other, echo.back_m, true);
    out.inside = out.inside && other.inside;
    out.pattern = std::sqrt(out.pattern * other.pattern);
    return out;
  }

  const RayWorld& world_;
  const TruthView& view_;
  const sonar::Head& head_;
  const sonar::HeadPatterns& patterns_;
  const std::vector<sonar::Mirror>& mirrors_;
  std::vector<TermImage>& images_;
  double finest_m_ = 1e9;       // range bin
  double most_bend_rad_ = 0.0;  // of any image's rays
  std::uint64_t cast_ = 0;
};

Result<std::vector<TermImage>> images_of(std::span<const scene::Sonar> sonars, std::size_t head,
                                         const TruthView& view) {
  std::vector<TermImage> images;
  for (const scene::Sonar& sonar : sonars) {
    NERITIC_TRY(const auto heads, sonar::plan_heads(sonar));
    NERITIC_TRY(TermImage image, TermImage::create(sonar, heads.at(head), view));
    images.push_back(std::move(image));
  }
  return images;
}

}  // namespace

Result<std::vector<TermTruth>> trace_terms(const RayWorld& world, const TruthView& view,
                                           std::span<const scene::Sonar> sonars, std::size_t head,
                                           const TruthRays& rays) {
  NERITIC_TRY(const auto heads, sonar::plan_heads(sonars.front()));
  sonar::Head plan = heads.at(head);
  // With bent rays the plan is taller than the heard elevation, by proportionally more rays.
  double taller = 1.0;
  for (const scene::Sonar& sonar : sonars) {
    if (!sonar.terms.profile || !sonar.terms.profile->bent) continue;
    NERITIC_TRY(const auto bent, sonar::plan_heads(sonar));
    const double up_rad = bent.at(head).samples.limits.elevation_max_rad,
                 front_up_rad = heads.at(head).samples.limits.elevation_max_rad;
    if (up_rad <= taller * front_up_rad) continue;
    plan = bent.at(head);
    taller = up_rad / front_up_rad;
  }
  const auto rays_of = [&](const Column& column) {
    return static_cast<std::uint32_t>(taller * (column.fine ? rays.rays : rays.rays / 4));
  };
  NERITIC_TRY(const sonar::HeadPatterns patterns, sonar::head_patterns(sonars.front()));
  const auto columns =
      columns_of(plan.folded ? plan.samples : plan.beams, sonars.front(), plan.folded, rays);
  std::vector<sonar::Mirror> mirrors;
  for (const scene::Sonar& sonar : sonars)
    if (mirrors.empty()) mirrors = sonar::mirrors_of(sonar);
  NERITIC_TRY(std::vector<TermImage> images, images_of(sonars, head, view));
  std::vector<TermImage> others = images;
  std::uint64_t cast[2] = {0, 0};
  const auto work = [&](std::vector<TermImage>& into, std::size_t thread) {
    Tracer tracer(world, view, plan, patterns, mirrors, into);
    // Pairs of columns in turns: each half of the columns goes to both threads.
    for (std::size_t i = 0; i < columns.size(); ++i)
      if (i / 2 % 2 == thread) tracer.trace(columns[i], static_cast<int>(i), rays_of(columns[i]));
    cast[thread] = tracer.cast();
  };
  std::thread other([&] { work(others, 1); });
  work(images, 0);
  other.join();
  std::vector<TermTruth> out;
  for (std::size_t i = 0; i < images.size(); ++i) {
    images[i].merge(others[i]);
    out.push_back({images[i].grid(), images[i].image(), images[i].half_difference(),
                   static_cast<double>(cast[0] + cast[1])});
  }
  return out;
}

}  // namespace neritic::tools
