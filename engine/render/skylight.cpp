#include "engine/render/skylight.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "shared/phase.h"

namespace neritic::render {
namespace {

// Rings of directions by their cosine to the vertical, each as wide in it as the next.
constexpr int kRings = 5;
constexpr std::array<int, kRings> kAround{14, 12, 10, 8, 4};
// Through a cell whose triangles cover a share s of it as light goes passes exp(-k s), with k from
// the first number, for a rail, to both together, for a wall: light that grazes a wall, or meets it
// in two cells, must not leak through what each leaves.
constexpr float kStop = 4.0f, kWallStops = 12.0f;
// Triangles are cut until their sides are no longer than this share of a cell, and no further than
// this many times.
constexpr double kPiece = 0.5;
constexpr int kMostCuts = 64;
// Farther corners are no part of a sea.
constexpr double kFarthest_m = 1e7;

struct Direction {
  Vec3 to_sky;
  double weight;  // of all: 1
};

double radiance(double cosine) {
  return shared::henyey_greenstein(static_cast<float>(cosine), shared::kDiffuseG);
}

std::vector<Direction> directions() {
  std::vector<Direction> out;
  double sum = 0.0;
  for (int ring = 0; ring < kRings; ++ring) {
    const double cosine = (ring + 0.5) / kRings, sine = std::sqrt(1.0 - cosine * cosine);
    const int count = kAround[static_cast<std::size_t>(ring)];
    for (int k = 0; k < count; ++k) {
      const double turn = 2.0 * kPi * (k + 0.3 + 0.2 * ring) / count;
      const double weight = radiance(cosine) / count;
      out.push_back({{sine * std::cos(turn), cosine, sine * std::sin(turn)}, weight});
      sum += weight;
    }
  }
  for (Direction& d : out) d.weight /= sum;
  return out;
}

// How much of a cell's three faces its triangles cover, over a face's area.
using Cover = std::array<float, 3>;

class Covers {
 public:
  Covers(const SkylightGrid& grid) : grid_(grid), covers_(grid.open.size(), Cover{}) {}

  void add(const WorldTriangle& t) {
    for (const Vec3& corner : t)
      if (!is_finite_within(corner, kFarthest_m)) return;
    add_piece(t[0], t[1], t[2], kMostCuts);
  }

  const Cover& operator[](std::size_t cell) const { return covers_[cell]; }

 private:
  void add_piece(const Vec3& a, const Vec3& b, const Vec3& c, int cuts) {
    const Vec3 size = grid_.cell_m * Vec3(grid_.nx, grid_.ny, grid_.nz);
    const Vec3 low = glm::min(a, glm::min(b, c)) - grid_.low_m;
    const Vec3 high = glm::max(a, glm::max(b, c)) - grid_.low_m;
    for (int i = 0; i < 3; ++i)
      if (!(high[i] >= 0.0 && low[i] < size[i])) return;
    const double ab = glm::distance(a, b), bc = glm::distance(b, c), ca = glm::distance(c, a);
    const double longest = std::max({ab, bc, ca});
    if (longest > kPiece * grid_.cell_m && cuts > 0) {
      // Across the longest side.
      const Vec3 &p = longest == ab   ? a
                      : longest == bc ? b
                                      : c,
                 &q = longest == ab   ? b
                      : longest == bc ? c
                                      : a,
                 &r = longest == ab   ? c
                      : longest == bc ? a
                                      : b;
      const Vec3 middle = 0.5 * (p + q);
      add_piece(p, middle, r, cuts - 1);
      add_piece(middle, q, r, cuts - 1);
      return;
    }
    const Vec3 cell = glm::floor(((a + b + c) / 3.0 - grid_.low_m) / grid_.cell_m);
    if (cell.x < 0.0 || cell.y < 0.0 || cell.z < 0.0 || cell.x >= grid_.nx || cell.y >= grid_.ny ||
        cell.z >= grid_.nz)
      return;
    const Vec3 area = 0.5 * glm::abs(glm::cross(b - a, c - a)) / (grid_.cell_m * grid_.cell_m);
    Cover& cover =
        covers_[grid_.cell_of(static_cast<std::size_t>(cell.x), static_cast<std::size_t>(cell.y),
                              static_cast<std::size_t>(cell.z))];
    for (std::size_t i = 0; i < 3; ++i) cover[i] += static_cast<float>(area[static_cast<int>(i)]);
  }

  const SkylightGrid& grid_;
  std::vector<Cover> covers_;
};

// Light of one direction goes through the grid a slab at a time, across the axis along which it
// goes fastest.
class Sweep {
 public:
  Sweep(const SkylightGrid& grid, const Covers& covers, const Direction& direction)
      : covers_(covers), d_(direction.to_sky), weight_(static_cast<float>(direction.weight)) {
    const Vec3 a = glm::abs(d_);
    main_ = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    u_ = (main_ + 1) % 3;
    v_ = (main_ + 2) % 3;
    n_ = {grid.nx, grid.ny, grid.nz};
    step_ = {1, std::ptrdiff_t(grid.nx) * grid.nz, std::ptrdiff_t(grid.nx)};
    for (int i = 0; i < 3; ++i) along_[i] = static_cast<float>(a[i] / a[main_]);
  }

  // Adds the light's share to each cell.
  void run(std::vector<float>& open) const {
    const std::size_t nu = n_[u_], nv = n_[v_];
    std::vector<float> before(nu * nv, 1.0f), now(nu * nv);
    const bool down = d_[main_] > 0.0;  // it comes from the far end of the main axis
    // From a cell's middle back to the slab before it, in cells.
    const double du = d_[u_] / std::abs(d_[main_]), dv = d_[v_] / std::abs(d_[main_]);
    for (std::size_t k = 0; k < n_[main_]; ++k) {
      const std::size_t slab = down ? n_[main_] - 1 - k : k;
      for (std::size_t v = 0; v < nv; ++v)
        for (std::size_t u = 0; u < nu; ++u) {
          const float in = k == 0 ? 1.0f
                                  : between(before, static_cast<double>(u) + du,
                                            static_cast<double>(v) + dv, nu, nv);
          const auto cell = static_cast<std::size_t>(std::ptrdiff_t(slab) * step_[main_] +
                                                     std::ptrdiff_t(u) * step_[u_] +
                                                     std::ptrdiff_t(v) * step_[v_]);
          const Cover& cover = covers_[cell];
          const float covered = cover[0] * along_[0] + cover[1] * along_[1] + cover[2] * along_[2];
          float half = 1.0f;  // up to the cell's middle
          if (covered > 0.0f) {
            const float area = cover[0] + cover[1] + cover[2];
            half = std::exp(-0.5f * (kStop + kWallStops * std::min(area, 1.0f)) * covered);
          }
          open[cell] += weight_ * in * half;
          now[v * nu + u] = in * half * half;
        }
      std::swap(before, now);
    }
  }

 private:
  // Between four cells of a slab; nothing stands beside the grid.
  static float between(const std::vector<float>& slab, double u, double v, std::size_t nu,
                       std::size_t nv) {
    const double u0 = std::floor(u), v0 = std::floor(v);
    const auto fu = static_cast<float>(u - u0), fv = static_cast<float>(v - v0);
    const auto of = [&](double at_u, double at_v) {
      if (at_u < 0.0 || at_v < 0.0 || at_u >= static_cast<double>(nu) ||
          at_v >= static_cast<double>(nv))
        return 1.0f;
      return slab[static_cast<std::size_t>(at_v) * nu + static_cast<std::size_t>(at_u)];
    };
    const float low = of(u0, v0) * (1.0f - fu) + of(u0 + 1, v0) * fu;
    const float high = of(u0, v0 + 1) * (1.0f - fu) + of(u0 + 1, v0 + 1) * fu;
    return low * (1.0f - fv) + high * fv;
  }

  const Covers& covers_;
  Vec3 d_;
  float weight_;
  int main_ = 1, u_ = 2, v_ = 0;
  std::array<std::size_t, 3> n_{};
  std::array<std::ptrdiff_t, 3> step_{};
  std::array<float, 3> along_{};
};

// So many cells from the box's sides and top, but no more than this share of a side, what the box
// takes away fades out: where open water begins, no edge is to be seen.
constexpr double kFade_cells = 10.0, kFadeShare = 1.0 / 6.0;

// By the middle of cell i of n. low: whether it fades at the low end too.
float kept(std::size_t i, std::size_t n, bool low) {
  const auto cells = static_cast<double>(n), at = static_cast<double>(i) + 0.5;
  const double fade = std::min(kFade_cells, kFadeShare * cells);
  const double to_edge = low ? std::min(at, cells - at) : cells - at;
  return static_cast<float>(glm::smoothstep(0.0, fade, to_edge));
}

void fade_out(SkylightGrid& grid) {
  std::size_t cell = 0;
  for (std::size_t y = 0; y < grid.ny; ++y)
    for (std::size_t z = 0; z < grid.nz; ++z)
      for (std::size_t x = 0; x < grid.nx; ++x, ++cell)
        grid.open[cell] = 1.0f - (1.0f - grid.open[cell]) * kept(x, grid.nx, true) *
                                     kept(y, grid.ny, false) * kept(z, grid.nz, true);
}

}  // namespace

double SkylightGrid::at(const Vec3& place_m) const {
  const Vec3 p = (place_m - low_m) / cell_m - 0.5;
  if (!(p.x >= -1 && p.y >= -1 && p.z >= -1 && p.x < nx && p.y < ny && p.z < nz)) return 1.0;
  double sum = 0.0;
  if (p.x >= 0 && p.y >= 0 && p.z >= 0 && p.x < nx - 1.0 && p.y < ny - 1.0 && p.z < nz - 1.0) {
    // Within the grid, where thousands of particles ask.
    const int x = static_cast<int>(p.x), y = static_cast<int>(p.y), z = static_cast<int>(p.z);
    const Vec3 part = p - Vec3(x, y, z);
    const double wx[] = {1.0 - part.x, part.x};
    const double low_y = 1.0 - part.y, low_z = 1.0 - part.z;
    const auto add_row = [&](const float* row, double wy, double wz) {
      sum += wx[0] * wy * wz * double(row[0]);
      sum += wx[1] * wy * wz * double(row[1]);
    };
    const float* const first =
        open.data() + cell_of(static_cast<std::size_t>(x), static_cast<std::size_t>(y),
                              static_cast<std::size_t>(z));
    const std::size_t up = cell_of(0, 1, 0), on = cell_of(0, 0, 1);
    add_row(first, low_y, low_z);
    add_row(first + up, part.y, low_z);
    add_row(first + on, low_y, part.z);
    add_row(first + up + on, part.y, part.z);
    return std::isfinite(sum) ? sum : 1.0;
  }
  const Vec3 base = glm::floor(p), part = p - base;
  for (int i = 0; i < 8; ++i) {
    const Vec3 corner(i & 1, i >> 1 & 1, i >> 2);
    const Vec3 c = base + corner, w = glm::mix(1.0 - part, part, corner);
    const bool inside = c.x >= 0 && c.y >= 0 && c.z >= 0 && c.x < nx && c.y < ny && c.z < nz;
    const double here =
        inside ? double(open[cell_of(static_cast<std::size_t>(c.x), static_cast<std::size_t>(c.y),
                                     static_cast<std::size_t>(c.z))])
               : 1.0;
    sum += w.x * w.y * w.z * here;
  }
  return std::isfinite(sum) ? sum : 1.0;
}

SkylightGrid skylight_grid(const scene::Skylight& box, std::span<const WorldTriangle> triangles) {
  SkylightGrid grid;
  grid.low_m = box.low_m;
  grid.cell_m = box.cell_m;
  const auto [nx, ny, nz] = scene::cells_of(box);
  grid.nx = nx;
  grid.ny = ny;
  grid.nz = nz;
  grid.open.assign(std::size_t{nx} * ny * nz, 0.0f);
  Covers covers(grid);
  for (const WorldTriangle& triangle : triangles) covers.add(triangle);
  for (const Direction& direction : directions()) Sweep(grid, covers, direction).run(grid.open);
  fade_out(grid);
  return grid;
}

std::vector<WorldTriangle> skylight_triangles(const scene::Scene& scene, const FrameState& state,
                                              std::span<const std::uint8_t> objects,
                                              const scene::Skylight& box) {
  std::vector<WorldTriangle> out;
  const auto add_mesh = [&](const scene::Model& model, const scene::Mesh& mesh, const Mat4& world) {
    for (const scene::Primitive& p : mesh.primitives) {
      if (p.topology != scene::Topology::kTriangles) continue;
      if (p.material >= 0 && model.materials[static_cast<std::size_t>(p.material)].alpha_mode !=
                                 scene::AlphaMode::kOpaque)
        continue;
      for (std::size_t i = 0; i + 2 < p.indices.size(); i += 3) {
        WorldTriangle t;
        for (std::size_t k = 0; k < 3; ++k)
          t[k] = Vec3(world * Vec4(Vec3(p.positions[p.indices[i + k]]), 1.0));
        const Vec3 low = glm::min(t[0], glm::min(t[1], t[2])),
                   high = glm::max(t[0], glm::max(t[1], t[2]));
        if (low.x <= box.high_m.x && low.y <= box.high_m.y && low.z <= box.high_m.z &&
            high.x >= box.low_m.x && high.y >= box.low_m.y && high.z >= box.low_m.z)
          out.push_back(t);
      }
    }
  };
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    const scene::Object& object = scene.objects[o];
    if (object.model < 0 || !objects[o]) continue;
    const scene::Model& model = *scene.models[static_cast<std::size_t>(object.model)];
    std::vector<int> open(model.roots);
    while (!open.empty()) {
      const auto n = static_cast<std::size_t>(open.back());
      open.pop_back();
      const scene::Node& node = model.nodes[n];
      open.insert(open.end(), node.children.begin(), node.children.end());
      if (node.mesh < 0) continue;
      const int copies = static_cast<int>(object.copies.size());
      const int instances = static_cast<int>(node.instances.size());
      for (int c = copies ? 0 : -1; c < copies; ++c)
        for (int i = instances ? 0 : -1; i < instances; ++i) {
          const Appearance a{static_cast<std::uint32_t>(o), static_cast<std::uint32_t>(n), c, i, 0};
          add_mesh(
              model, model.meshes[static_cast<std::size_t>(node.mesh)],
              world_from_appearance(scene, state.world_from_object[o], state.poses[o], a, false));
        }
    }
  }
  return out;
}

}  // namespace neritic::render
