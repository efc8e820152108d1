// The parts of a file of cases of decompression (deco_cases.hpp) that its readers share. Each
// getter records what is wrong in the file. One thread.
#pragma once

#include "diver/deco_cases.hpp"
#include "diver/gas_label.hpp"
#include "engine/core/case_file.hpp"

namespace neritic::diver {

// A number of the field within bounds, or nothing where it is absent.
Expected expected_number(const CaseField& field);
// 16 rows of nitrogen, helium; nothing where absent or wrong.
std::optional<TissueState> read_tissues(const CaseField& field);
// "ZH-L16B-GF" (first compartment 1b, 5 min) or "ZH-L16C-GF" (compartment 1, 4 min).
void read_model(const CaseField& model, DecoConventions& conventions);
// Each member present replaces the request's value.
void read_parameters(const CaseField& parameters, DivePlanRequest& request);
std::vector<PlanGas> read_gases(const CaseField& gases);
// depth_m, and the run time in the member `leave`.
PlanLevel read_level(const CaseField& field, const char* leave);
// kind, depth_m, bottom_runtime_min, levels of `profile`.
std::vector<PlanLevel> read_levels(const CaseField& profile);
// A list of depth_m, minutes, and gf_next, o2, he where they are there.
std::optional<std::vector<ExpectedStop>> read_stops(const CaseField& list);
// Rows of depth, minutes.
std::optional<std::vector<ExpectedStop>> read_stop_rows(const CaseField& list);
// Both read the parts of one profile.
DecoExpected read_expected(const CaseField& profile);
std::optional<EarlierCase> read_earlier(const CaseField& repetitive, const DivePlanRequest& base);

}  // namespace neritic::diver
