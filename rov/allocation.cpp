#include "rov/allocation.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/core/check.hpp"

namespace neritic::rov {
namespace {

using Row = std::array<double, kMaxThrusters>;

double dot_rows(const Row& a, const Row& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

// Turns (a, b) by the angle of cosine c and sine s.
template <class T>
void turn(T& a, T& b, std::size_t size, double c, double s) {
  for (std::size_t k = 0; k < size; ++k) {
    const double x = a[k], y = b[k];
    a[k] = c * x - s * y;
    b[k] = s * x + c * y;
  }
}

// Makes the six rows orthogonal; turns collects the rotations, one a row.
void orthogonalise(std::array<Row, 6>& rows, std::array<Vec6, 6>& turns) {
  for (int sweep = 0; sweep < 60; ++sweep) {
    bool done = true;
    for (std::size_t i = 0; i < 6; ++i)
      for (std::size_t j = i + 1; j < 6; ++j) {
        const double a = dot_rows(rows[i], rows[i]), b = dot_rows(rows[j], rows[j]);
        const double c = dot_rows(rows[i], rows[j]);
        if (std::abs(c) <= 1e-16 * std::sqrt(a * b) || c == 0.0) continue;
        done = false;
        const double zeta = (b - a) / (2.0 * c);
        const double t = std::copysign(1.0, zeta) / (std::abs(zeta) + std::hypot(1.0, zeta));
        const double cosine = 1.0 / std::hypot(1.0, t);
        turn(rows[i], rows[j], kMaxThrusters, cosine, cosine * t);
        turn(turns[i], turns[j], 6, cosine, cosine * t);
      }
    if (done) return;
  }
}

}  // namespace

PseudoInverse pseudo_inverse(ThrusterMatrix columns) {
  NERITIC_CHECK(columns.size() <= kMaxThrusters, "{} thrusters", columns.size());
  std::array<Row, 6> rows{};
  std::array<Vec6, 6> turns;
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t k = 0; k < columns.size(); ++k) rows[i][k] = columns[k][i];
    turns[i][i] = 1.0;
  }
  orthogonalise(rows, turns);
  // Now rows = T B with T = turns orthogonal, so B^+ = rows^+ T, and rows^+ has the columns
  // rows_i / |rows_i|^2.
  PseudoInverse out;
  std::array<double, 6> norms{};
  for (std::size_t i = 0; i < 6; ++i) norms[i] = std::sqrt(dot_rows(rows[i], rows[i]));
  const double largest = *std::ranges::max_element(norms);
  for (std::size_t i = 0; i < 6; ++i) {
    if (!(norms[i] > 1e-12 * largest)) continue;
    ++out.rank;
    for (std::size_t k = 0; k < columns.size(); ++k)
      out.rows[k] = out.rows[k] + rows[i][k] / (norms[i] * norms[i]) * turns[i];
  }
  std::ranges::sort(norms, std::greater());
  out.singular_values = {norms};
  return out;
}

Allocator::Allocator(const Vehicle& vehicle, std::uint64_t failed)
    : count_(vehicle.thruster_count) {
  for (std::size_t i = 0; i < count_; ++i) {
    if (failed >> i & 1u) continue;  // a column of zeros: its force is 0
    columns_[i] = vehicle.thruster_wrench[i];
    min_n_[i] = vehicle.thrusters[i].min_n;
    max_n_[i] = vehicle.thrusters[i].max_n;
  }
  inverse_ = pseudo_inverse({columns_.data(), count_});
}

Allocator::Allocator(ThrusterMatrix columns, std::span<const double> min_n,
                     std::span<const double> max_n)
    : count_(columns.size()), inverse_(pseudo_inverse(columns)) {
  NERITIC_CHECK(min_n.size() == count_ && max_n.size() == count_, "{} and {} limits of {}",
                min_n.size(), max_n.size(), count_);
  std::ranges::copy(columns, columns_.begin());
  std::ranges::copy(min_n, min_n_.begin());
  std::ranges::copy(max_n, max_n_.begin());
}

Allocation Allocator::allocate(const Vec6& wrench, Saturation saturation,
                               const std::array<double, kMaxThrusters>& beside_n) const {
  Allocation out;
  std::array<double, kMaxThrusters> rise_n{};
  for (std::size_t i = 0; i < count_; ++i) {
    rise_n[i] = dot(inverse_.rows[i], wrench);
    out.wanted_n[i] = beside_n[i] + rise_n[i];
  }
  out.force_n = beside_n;
  out.scale = raise(rise_n, 1.0, out.force_n);
  if (saturation == Saturation::kRedistribute && out.scale < 1.0)
    redistribute(wrench_of(rise_n), out);
  return out;
}

// Adds the largest share of rise_n that the limits leave, at most as much as asked; returns it.
double Allocator::raise(const std::array<double, kMaxThrusters>& rise_n, double most,
                        std::array<double, kMaxThrusters>& force_n) const {
  double share = most;
  for (std::size_t i = 0; i < count_; ++i) {
    if (rise_n[i] > 0.0) share = std::min(share, (max_n_[i] - force_n[i]) / rise_n[i]);
    if (rise_n[i] < 0.0) share = std::min(share, (min_n_[i] - force_n[i]) / rise_n[i]);
  }
  share = std::max(share, 0.0);
  for (std::size_t i = 0; i < count_; ++i)  // clamped: the product rounds
    force_n[i] = std::clamp(force_n[i] + share * rise_n[i], min_n_[i], max_n_[i]);
  return share;
}

void Allocator::redistribute(const Vec6& wrench, Allocation& out) const {
  for (std::size_t round = 0; round < count_ && out.scale < 1.0; ++round) {
    std::array<Vec6, kMaxThrusters> open{};  // columns of those that can give more; else 0
    for (std::size_t i = 0; i < count_; ++i) {
      const double slack = 1e-9 * (max_n_[i] - min_n_[i]);
      if (out.force_n[i] < max_n_[i] - slack && out.force_n[i] > min_n_[i] + slack)
        open[i] = columns_[i];
    }
    const PseudoInverse more = pseudo_inverse({open.data(), count_});
    std::array<double, kMaxThrusters> rise_n{};  // of the forces, for all of the wrench
    for (std::size_t i = 0; i < count_; ++i) rise_n[i] = dot(more.rows[i], wrench);
    const Vec6 off = wrench_of(rise_n) - wrench;
    if (dot(off, off) > 1e-18 * dot(wrench, wrench)) return;
    out.scale += raise(rise_n, 1.0 - out.scale, out.force_n);
  }
}

Vec6 Allocator::wrench_of(const std::array<double, kMaxThrusters>& force_n) const {
  Vec6 sum;
  for (std::size_t i = 0; i < count_; ++i) sum = sum + force_n[i] * columns_[i];
  return sum;
}

double Allocator::largest(const Vec6& direction) const {
  return 1e6 * allocate(1e6 * direction, Saturation::kRedistribute).scale;
}

}  // namespace neritic::rov
