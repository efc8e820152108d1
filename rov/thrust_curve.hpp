// Static thrust of a motor against its speed controller's pulse width and the supply's voltage,
// from a measured table, and back. Plain values; any thread.
#pragma once

#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "engine/core/result.hpp"

namespace neritic::rov {

class ThrustCurve {
 public:
  // thrust_n: a row a pulse width, a column a voltage; both rise. Each column is made monotone (the
  // nearest sequence that never falls, by pooling adjacent violators; Barlow et al. 1972), so that
  // the way back is unique. Errors: fewer than two rows, tables of the wrong size, what is not
  // finite.
  static Result<ThrustCurve> make(std::vector<double> pwm_us, std::vector<double> volts,
                                  std::vector<std::vector<double>> thrust_n);
  // A .csv whose heading names the columns: pwm_us, then thrust_n_16v and so on; other columns are
  // ignored; '#' begins a comment.
  static Result<ThrustCurve> parse(std::string_view text, const std::string& name);
  static Result<ThrustCurve> read(const std::filesystem::path& path);

  // Linear between the table's rows and columns, and its ends' value beyond them.
  double thrust_n(double pwm_us, double volts) const;
  // The pulse width that gives the force, linear between rows; the middle of the dead band for 0,
  // the ends where it is more than the motor can.
  double pwm_us(double thrust_n, double volts) const;
  // The thrust of a commanded force: its pulse width in whole microseconds, and the thrust at that
  // width. One that is not finite stays so, for step() to refuse.
  double realised_n(double commanded_n, double volts) const;

  double least_n(double volts) const { return thrust_n(pwm_us_.front(), volts); }
  double most_n(double volts) const { return thrust_n(pwm_us_.back(), volts); }
  // The pulse widths between which there is no thrust.
  std::pair<double, double> dead_band_us(double volts) const;

 private:
  // The table's row at a voltage between its columns.
  double at(std::size_t row, double volts) const;
  std::vector<double> pwm_us_, volts_;
  std::vector<std::vector<double>> thrust_n_;
};

}  // namespace neritic::rov
