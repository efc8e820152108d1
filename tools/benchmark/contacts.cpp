// The cost of contacts against the triangles of what is touched: a box of an ROV's size that slides
// over a seabed, of a mesh and of a grid of heights, larger and larger or finer and finer.
#include "engine/core/clock.hpp"
#include "engine/core/hash.hpp"
#include "engine/sim/contact_memory.hpp"
#include "engine/sim/motion.hpp"
#include "tools/benchmark/groups.hpp"

namespace neritic::bench {
namespace {

// So that milliseconds are microseconds a step.
constexpr int kSlides = 1000;
constexpr double kSlide_s = 1.0 / 240.0;

// A low swell, rows and columns alike, centred.
struct Seabed {
  std::uint32_t samples = 0;
  double cell_m = 0.0;
  std::vector<float> heights_m;
};

Seabed make_seabed(double triangles, double side_m) {
  Seabed out;
  const double cells = std::round(std::sqrt(0.5 * triangles));
  out.samples = static_cast<std::uint32_t>(cells) + 1;
  out.cell_m = side_m / cells;
  for (std::uint32_t row = 0; row < out.samples; ++row)
    for (std::uint32_t column = 0; column < out.samples; ++column) {
      const double x = column * out.cell_m - 0.5 * side_m, z = row * out.cell_m - 0.5 * side_m;
      out.heights_m.push_back(static_cast<float>(0.02 * std::sin(1.3 * x) * std::cos(0.9 * z)));
    }
  return out;
}

Result<sim::StaticWorld> as_grid(const Seabed& seabed) {
  sim::StaticWorldBuilder builder;
  NERITIC_TRY(const auto shape, builder.add_heights(seabed.samples, seabed.samples, seabed.cell_m,
                                                    seabed.heights_m, "seabed"));
  builder.place(shape, {}, {});
  return builder.build();
}

Result<sim::StaticWorld> as_mesh(const Seabed& seabed) {
  std::vector<Vec3f> vertices_m;
  std::vector<std::uint32_t> indices;
  const std::uint32_t n = seabed.samples;
  for (std::uint32_t row = 0; row < n; ++row)
    for (std::uint32_t column = 0; column < n; ++column) {
      vertices_m.emplace_back((column - 0.5 * (n - 1)) * seabed.cell_m,
                              seabed.heights_m[std::size_t{row} * n + column],
                              (row - 0.5 * (n - 1)) * seabed.cell_m);
      if (row + 1 == n || column + 1 == n) continue;
      const std::uint32_t nw = row * n + column, ne = nw + 1, sw = nw + n, se = sw + 1;
      indices.insert(indices.end(), {nw, sw, ne, ne, sw, se});
    }
  sim::StaticWorldBuilder builder;
  NERITIC_TRY(const auto shape, builder.add_mesh(vertices_m, indices, "seabed"));
  builder.place(shape, {}, {});
  return builder.build();
}

// An ROV's box, 20 kg with 20 N of weight in water, pushed along. above_m: nothing is touched.
Sample slide(const sim::StaticWorld& world, double above_m) {
  sim::BodyShape shape;
  shape.add_box({}, {0.23, 0.13, 0.28});
  sim::InverseMass inverse_mass{};
  for (std::size_t i = 0; i < 6; ++i) inverse_mass[7 * i] = i < 3 ? 1.0 / 20.0 : 2.0;
  sim::BodyMotion motion{{{0.1, 0.16 + above_m, 0.1}, Quat(1.0, 0.0, 0.0, 0.0)}, {}};
  motion.velocity.linear = Vec3(0.2, 0.0, 0.1);
  sim::ContactMemory memory;
  TimeNs spent = 0;
  int touched = 0;
  for (int i = 0; i < kSlides; ++i) {
    const Pose before = motion.world_from_body;
    sim::BodyMotion free = motion;
    const Vec3 push = (above_m > 0.0 ? Vec3(0.0) : Vec3(0.5, -1.0, 0.0)) * kSlide_s;
    free.velocity.linear += glm::conjugate(before.rotation) * push;
    free.world_from_body = sim::moved(before, free.velocity, kSlide_s);
    sim::MotionReport report;
    const TimeNs begin = now_ns();
    motion = sim::move_body(world, shape, inverse_mass, before, free, kSlide_s, memory, &report);
    spent += now_ns() - begin;
    touched += report.touched ? 1 : 0;
  }
  Hash64 hash;
  hash.add(motion.world_from_body.position_m);
  hash.add(motion.world_from_body.rotation);
  hash.add(touched);
  return {to_ms(spent), {}, hash.hex()};
}

}  // namespace

Status bench_contacts(Suite& suite) {
  if (!suite.wants("contacts")) return {};
  constexpr double kCell_m = 0.5, kPatch_m = 10.0;
  std::vector<std::unique_ptr<sim::StaticWorld>> worlds;
  std::vector<Contender> contenders;
  const auto add = [&](const std::string& name, double triangles,
                       Result<sim::StaticWorld> made) -> Status {
    NERITIC_TRY(sim::StaticWorld world, std::move(made));
    worlds.push_back(std::make_unique<sim::StaticWorld>(std::move(world)));
    const sim::StaticWorld& w = *worlds.back();
    const Facts facts{{"triangles", triangles}};
    contenders.push_back({fmt::format("contacts/{}_{:.0f}", name, triangles),
                          [&w]() -> Result<Sample> { return slide(w, 0.0); }, facts});
    if (triangles == 1e6)
      contenders.push_back({fmt::format("contacts/{}_{:.0f}_out_of_reach", name, triangles),
                            [&w]() -> Result<Sample> { return slide(w, 1.0); }, facts});
    return {};
  };
  for (const double triangles : {1e2, 1e3, 1e4, 1e5, 1e6}) {
    const Seabed wide = make_seabed(triangles, kCell_m * std::sqrt(0.5 * triangles)),
                 fine = make_seabed(triangles, kPatch_m);
    NERITIC_TRY_STATUS(add("larger_mesh", triangles, as_mesh(wide)));
    NERITIC_TRY_STATUS(add("larger_grid", triangles, as_grid(wide)));
    NERITIC_TRY_STATUS(add("finer_mesh", triangles, as_mesh(fine)));
    NERITIC_TRY_STATUS(add("finer_grid", triangles, as_grid(fine)));
  }
  return suite.measure(std::move(contenders), 9);
}

}  // namespace neritic::bench
