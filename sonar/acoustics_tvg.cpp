#include "sonar/acoustics_tvg.hpp"

#include "sonar/acoustics.hpp"

namespace neritic::sonar {
namespace {
constexpr TableFormat kFormat{"range_m", "gain_db", 0.0, 1e6, -300.0, 300.0};
}

double Tvg::gain_db(double range_m, double absorption_db_m) const {
  if (!range_gain.empty()) return interpolate(range_gain, range_m);
  const double absorption_db = compensate_absorption ? 2.0 * absorption_db_m * range_m : 0.0;
  return spreading_log / 20.0 * spherical_spreading_db(range_m) + absorption_db;
}

Status validate(const Tvg& tvg) {
  if (!tvg.range_gain.empty()) return validate(tvg.range_gain, "TVG table", kFormat);
  if (!(tvg.spreading_log >= 0.0 && tvg.spreading_log <= 80.0))
    return bad_input("TVG: spreading factor {}; accepted: 0 to 80 (20, 30, 40 are usual)",
                     tvg.spreading_log);
  return {};
}

Result<Tvg> read_tvg(const std::filesystem::path& path) {
  NERITIC_TRY(Table table, read_table(path, kFormat));
  return Tvg{0.0, false, std::move(table)};
}

}  // namespace neritic::sonar
