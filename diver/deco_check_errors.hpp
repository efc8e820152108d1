// The errors that the check of one decompression case gathers. One thread.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "diver/deco_cases.hpp"
#include "engine/core/check_result.hpp"

namespace neritic::diver {

// The worst error a quantity, in the order in which they were first compared.
class DecoErrors {
 public:
  explicit DecoErrors(std::string id) : result_{std::move(id), {}} {}

  void add(const std::string& what, const std::string& unit, double error, double tolerance) {
    auto at = std::ranges::find(result_.errors, what, &CheckedError::what);
    if (at == result_.errors.end()) {
      result_.errors.push_back({what, unit, 0.0, tolerance});
      at = result_.errors.end() - 1;
    }
    at->error = std::isnan(error) ? error : std::max(at->error, std::abs(error));
  }
  void add(const std::string& what, const std::string& unit, double found, const Expected& expected,
           double tolerance) {
    if (expected) add(what, unit, found - *expected, tolerance);
  }
  // Records that nothing could be planned: an infinite error.
  void add_failure(const std::string& what) {
    add(what, "", std::numeric_limits<double>::infinity(), 1.0);
  }
  CaseResult take() {
    if (result_.errors.empty()) add_failure("nothing to compare");
    return std::move(result_);
  }

 private:
  CaseResult result_;
};

}  // namespace neritic::diver
