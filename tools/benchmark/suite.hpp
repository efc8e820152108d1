// Runs contenders round by round, so that what disturbs the machine disturbs all of them alike, and
// keeps their times, the hashes of their results and the ratios between them. A result that differs
// between two rounds is a failure: speed must not buy wrongness. One thread.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "engine/core/result.hpp"

namespace neritic::bench {

struct Options {
  bool quick = false;  // few rounds
  bool sweep = false;  // also the scaling sweeps
  bool once = false;   // one round of what has a hash: how a second thread count is compared
  std::string filter;  // a group, or part of a GROUP/NAME: only these
  std::string device;
  std::string json;
  std::string assets = "assets";
};

// One round of one contender. parts: named shares of it in ms, kept as medians.
struct Sample {
  double ms = 0.0;
  std::map<std::string, double> parts;
  std::string hash;
};

// Sizes, counts, settings: what a figure is about.
using Fact = std::variant<double, std::string, std::vector<double>>;
using Facts = std::map<std::string, Fact>;

struct Contender {
  std::string name;
  std::function<Result<Sample>()> run;
  Facts facts;
  // One untimed run before each timed one, so that a contender finds its own data in the caches and
  // not the half gigabyte of the one before it.
  bool warm = false;
};

struct Measured {
  std::string name, hash;
  std::vector<double> ms;      // wall time, or GPU time where the name says so
  std::vector<double> cpu_ms;  // of all threads and child processes, the hashing included
  std::map<std::string, std::vector<double>> parts;
  Facts facts;
  double median_ms() const;
  double min_ms() const;
};

double median(std::vector<double> values);

struct Aim {
  std::string what, unit;
  double reached = 0.0, limit = 0.0;
  bool at_most = true;  // or at least
  bool met() const { return at_most ? reached <= limit : reached >= limit; }
};

class Suite {
 public:
  explicit Suite(const Options& options) : options_(options) {}
  const Options& options() const { return options_; }
  bool wants(const std::string& group) const;
  // Rounds: the default, fewer where a round takes long or --quick asks for it.
  Status measure(std::vector<Contender> contenders, int rounds = 25);
  const Measured* find(const std::string& name) const;
  // Least time of numerator / least time of denominator, both of this run: other programs only ever
  // add time, and to two threads more than to one. The ratio of the medians is kept beside it.
  void ratio(const std::string& name, const std::string& numerator, const std::string& denominator);
  // The hashes of two ways to the same result are the same, or the run fails.
  void must_agree(const std::string& a, const std::string& b);
  void fail(const std::string& what) { failures_.push_back(what); }
  // Aims: printed with what was reached; no failures, since they depend on the machine. For the
  // median of a result, for any figure, and for a ratio of this run.
  void aim_ms(const std::string& what, const std::string& result, double limit_ms);
  void aim_most(const std::string& what, const std::string& unit, double reached, double at_most);
  void aim_ratio(const std::string& what, const std::string& ratio, double at_least);

  // A fact of the whole run, beside the ratios.
  void note(const std::string& name, Fact value) { facts_[name] = std::move(value); }

  // Everything as a JSON file.
  Status write(const std::string& file, const std::string& device, unsigned threads) const;
  void print() const;
  const std::vector<std::string>& failures() const { return failures_; }
  const std::vector<Measured>& results() const { return results_; }

 private:
  Options options_;
  std::vector<Measured> results_;
  struct Ratio {
    double of_least = 0.0, of_medians = 0.0;
  };
  std::map<std::string, Ratio> ratios_;
  Facts facts_;
  std::vector<Aim> aims_;
  std::vector<std::string> failures_;
};

// Name and hash of every result in a file that Suite::write made.
Result<std::map<std::string, std::string>> read_hashes(const std::string& file);

}  // namespace neritic::bench
