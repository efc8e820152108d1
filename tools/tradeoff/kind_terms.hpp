// The cost of each term of a kind, its error, and the error of leaving it out. Rendering
// thread.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tools/tradeoff/kind_bench.hpp"
#include "tools/tradeoff/kind_sweep.hpp"

namespace neritic::tools {

struct TermSweepInputs {
  const KindSetting& kind;
  KindBench& bench;
  const KindSweepOptions& options;
  const std::vector<TermCase>& cases;
  // The rays' images: of each case by its name, without its noise.
  const std::map<std::string, std::vector<double>>& truths;
  int repeats = 1;
};
// Adds a line a case, and one a size of scatterers, table and count; calls step for each case and
// once more.
Status sweep_terms(const TermSweepInputs& inputs, KindResult& out);

}  // namespace neritic::tools
