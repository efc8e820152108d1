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
// "ZH-L16B-GF" and the words about compartment 1.
void read_model(const CaseField& model, const CaseField& table, DecoConventions& conventions);
// What is given replaces what the request has.
void read_parameters(const CaseField& parameters, DivePlanRequest& request);
std::vector<PlanGas> read_gases(const CaseField& gases);
// "air...", "O2...", "32/0...": of a surface interval.
GasMix read_surface_gas(const CaseField& field);
// kind, depth_m, bottom_runtime_min, levels of `profile`.
std::vector<PlanLevel> read_levels(const CaseField& profile);
// A list of depth_m, minutes, and gf_next, o2, he where they are there; or rows of depth, minutes.
std::optional<std::vector<ExpectedStop>> read_stops(const CaseField& list);
// Of one profile.
DecoExpected read_expected(const CaseField& profile);
std::vector<EarlierCase> read_earlier(const CaseField& repetitive, const DivePlanRequest& base);

}  // namespace neritic::diver
