// From a wanted wrench to thruster forces: the pseudo-inverse of B, f = B^+ tau (Fossen 2011,
// section 12.3). Forces beyond the thrusters' limits are scaled so that the wrench keeps its
// direction. Made once, anew when a thruster fails; then without allocation. Any thread.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "rov/vehicle.hpp"

namespace neritic::rov {

// The wrenches of one newton each as columns, 6 x n.
using ThrusterMatrix = std::span<const Vec6>;

struct PseudoInverse {
  std::array<Vec6, kMaxThrusters> rows;  // n x 6
  Vec6 singular_values;                  // falling
  int rank = 0;
};

// By one-sided Jacobi rotations of B's rows (Hestenes 1958; Golub, Van Loan 2013, section 8.6.3).
// Singular values below 1e-12 of the largest count as zero. Precondition: at most kMaxThrusters
// columns.
PseudoInverse pseudo_inverse(ThrusterMatrix columns);

enum class Saturation {
  kScale,  // all forces by one factor
  // Then what is missing from the thrusters that are not yet at a limit, their own pseudo-inverse
  // along the same direction, until no more can be had (after Bodson 2002, redistributed
  // pseudo-inverse). Uses the null space: 14 % more surge of the BlueROV2 Heavy.
  kRedistribute,
};

struct Allocation {
  std::array<double, kMaxThrusters> wanted_n{};  // B^+ tau
  std::array<double, kMaxThrusters> force_n{};   // within the limits
  double scale = 1.0;                            // of the wrench that is given, from 0
};

class Allocator {
 public:
  // Bit i of failed: thruster i is left out, the others bear its share as far as they can.
  explicit Allocator(const Vehicle& vehicle, std::uint64_t failed = 0);
  Allocator(ThrusterMatrix columns, std::span<const double> min_n, std::span<const double> max_n);

  // beside_n: forces that the thrusters give already, within their limits, and keep giving. The
  // wrench gets the room that they leave; wanted_n and force_n are sums with them.
  Allocation allocate(const Vec6& wrench, Saturation saturation = Saturation::kScale,
                      const std::array<double, kMaxThrusters>& beside_n = {}) const;
  // The wrench of the forces: B f.
  Vec6 wrench_of(const std::array<double, kMaxThrusters>& force_n) const;
  const PseudoInverse& inverse() const { return inverse_; }
  std::size_t count() const { return count_; }
  // The largest s, up to 1e6, for which s * direction is given in full, by kRedistribute.
  double largest(const Vec6& direction) const;

 private:
  double raise(const std::array<double, kMaxThrusters>& rise_n, double most,
               std::array<double, kMaxThrusters>& force_n) const;
  void redistribute(const Vec6& wrench, Allocation& allocation) const;
  std::size_t count_ = 0;
  std::array<Vec6, kMaxThrusters> columns_;
  std::array<double, kMaxThrusters> min_n_{}, max_n_{};
  PseudoInverse inverse_;
};

}  // namespace neritic::rov
