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
};

struct Measured {
  std::string name, hash;
  std::vector<double> ms;      // wall time, or GPU time where the name says so
  std::vector<double> cpu_ms;  // of all threads of this process, the hashing included
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
  // median of numerator / median of denominator, both measured in this run.
  void ratio(const std::string& name, const std::string& numerator, const std::string& denominator);
  // The hashes of two ways to the same result are the same, or the run fails.
  void must_agree(const std::string& a, const std::string& b);
  void fail(const std::string& what) { failures_.push_back(what); }
  // An aim: printed with what was reached; no failure, since it depends on the machine.
  void aim(const std::string& what, double reached, double limit, bool at_most,
           const std::string& unit);
  // The same for the median of a result of this run.
  void aim_ms(const std::string& what, const std::string& result, double limit_ms);

  // A fact of the whole run, beside the ratios.
  void note(const std::string& name, nlohmann::json value) { facts_[name] = std::move(value); }

  nlohmann::json to_json(const std::string& device, unsigned threads) const;
  void print() const;
  const std::vector<std::string>& failures() const { return failures_; }
  const std::vector<Measured>& results() const { return results_; }

 private:
  Options options_;
  std::vector<Measured> results_;
  nlohmann::json ratios_ = nlohmann::json::object();
  nlohmann::json facts_ = nlohmann::json::object();
  nlohmann::json aims_ = nlohmann::json::array();
  std::vector<std::string> failures_;
};

}  // namespace neritic::bench
