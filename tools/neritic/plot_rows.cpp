#include "tools/neritic/plot_rows.hpp"

namespace neritic::tools {
using namespace testbed;
namespace {

// A picture tells no more rows apart; of many participants each has fewer.
constexpr std::size_t kMostRowsOfKind = 1800, kMostRowsOfAll = 48000;

}  // namespace

std::size_t danger_bits(const HumanRow& row) {
  const diver::RiskProxies& risk = row.vitals.risk;
  const bool high = std::max({risk.co2, risk.narcosis, risk.gas_density, risk.breathing}) >=
                    diver::RiskLevel::kHigh;
  return static_cast<std::size_t>(row.ascent.view.alarm) |
         (row.ascent.view.ceiling_violated ? 4u : 0u) | (high ? 8u : 0u) |
         (risk.oxygen >= diver::RiskLevel::kHigh ? 16u : 0u) | (row.out_of_gas_s > 0.0 ? 32u : 0u);
}

PlotRows::PlotRows(const PhysicsWorld& world) {
  const std::size_t all = world.vehicles().size() + world.humans().size();
  const std::size_t most =
      std::min(kMostRowsOfKind, kMostRowsOfAll / std::max<std::size_t>(all, 1) + 1);
  vehicles_.assign(world.vehicles().size(), ThinnedRows<DiveRow>(most));
  humans_.assign(world.humans().size(), ThinnedRows<HumanRow>(most));
}

void PlotRows::add(const DiveRows& rows) {
  for (const DiveRow& row : rows.vehicles) vehicles_[row.vehicle].add(row, row.arrived);
  for (const HumanRow& row : rows.humans)
    humans_[row.human].add(row, danger_bits(row) | (row.tank << 6));
}

}  // namespace neritic::tools
