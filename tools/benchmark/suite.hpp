// Runs contenders round by round, so that what disturbs the machine disturbs all of them alike, and
// keeps their times, the hashes of their results and the ratios between them. A result that differs
// between two rounds is a failure: speed must not buy wrongness. One thread.
#pragma once

#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
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

struct Contender {
  std::string name;
  std::function<Result<Sample>()> run;
  nlohmann::json facts = nlohmann::json::object();  // sizes, counts, settings
  // One untimed run before each timed one, so that a contender finds its own data in the caches and
  // not the half gigabyte of the one before it.
  bool warm = false;
};

struct Measured {
  std::string name, hash;
  std::vector<double> ms;      // wall time, or GPU time where the name says so
  std::vector<double> cpu_ms;  // of all threads and child processes, the hashing included
  std::map<std::string, std::vector<double>> parts;
  nlohmann::json facts;
  double median_ms() const;
  double min_ms() const;
};

double median(std::vector<double> values);

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
  // median of a result, and for a ratio of this run.
  void aim_ms(const std::string& what, const std::string& result, double limit_ms);
  void aim_ratio(const std::string& what, const std::string& ratio, double at_least);

  // A fact of the whole run, beside the ratios.
  void note(const std::string& name, nlohmann::json value) { facts_[name] = std::move(value); }

  nlohmann::json to_json(const std::string& device, unsigned threads) const;
  void print() const;
  const std::vector<std::string>& failures() const { return failures_; }
  const std::vector<Measured>& results() const { return results_; }

 private:
  void aim(const std::string& what, double reached, double limit, bool at_most,
           const std::string& unit);
  Options options_;
  std::vector<Measured> results_;
  nlohmann::json ratios_ = nlohmann::json::object(), median_ratios_ = nlohmann::json::object();
  nlohmann::json facts_ = nlohmann::json::object();
  nlohmann::json aims_ = nlohmann::json::array();
  std::vector<std::string> failures_;
};

}  // namespace neritic::bench
