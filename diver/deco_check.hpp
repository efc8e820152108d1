// Holds the planner against a file of cases (deco_cases.hpp). Pure functions; any thread.
#pragma once

#include <vector>

#include "diver/deco_cases.hpp"
#include "engine/core/check_result.hpp"

namespace neritic::diver {

// A result a case: the dives, then the tables of times without stops.
std::vector<CaseResult> check_deco(const DecoCases& cases);

CaseResult check_dive(const DecoCase& one, const DecoCases& tolerances);
CaseResult check_table(const NdlTable& table, const DecoCases& tolerances);

}  // namespace neritic::diver
