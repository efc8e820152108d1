// Valid graphs drawn at random, for properties that must hold for all. The same seed gives the same
// graph.
#pragma once

#include "graph_maker.hpp"

namespace neritic::graph {

struct RandomGraph {
  GraphMaker maker;
  std::vector<MemoryNeed> needs;  // odd sizes, several alignments, two classes a kind
};
RandomGraph random_graph(std::uint64_t seed);

}  // namespace neritic::graph
