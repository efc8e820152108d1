// Any bytes as a file of cases of decompression: an Error in one line, or cases whose plans are
// finite or say why they are none.
#include <cmath>

#include "diver/deco_check.hpp"
#include "engine/core/check.hpp"
#include "tests/fuzz/replay.hpp"

namespace {

void expect_finite(const neritic::diver::TissueState& tissues, const std::string& id) {
  for (std::size_t i = 0; i < neritic::diver::kCompartments; ++i)
    NERITIC_CHECK(std::isfinite(tissues.n2_bar[i]) && std::isfinite(tissues.he_bar[i]),
                  "not finite in {}", id);
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace neritic;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto cases = diver::read_deco_cases(text, "fuzz.json");
  if (!cases.ok()) {
    const std::string& message = cases.error().message;
    NERITIC_CHECK(message.starts_with("fuzz.json") && message.find('\n') == message.npos, "{}",
                  message);
    return 0;
  }
  // The first few alone: long stops of many dives are no promise of the reader.
  for (std::size_t i = 0; i < std::min<std::size_t>(cases->dives.size(), 3); ++i) {
    const diver::DecoCase& one = cases->dives[i];
    const CaseResult result = diver::check_dive(one, *cases);
    NERITIC_CHECK(!result.errors.empty(), "nothing compared in {}", one.id);
    for (const CheckedError& e : result.errors)
      NERITIC_CHECK(e.what.find('\n') == e.what.npos && e.tolerance >= 0.0, "{}", e.what);
    const auto plan = diver::plan_dive(one.request);
    if (plan.ok()) expect_finite(plan->surfacing.tissues, one.id);
  }
  for (std::size_t i = 0; i < std::min<std::size_t>(cases->tables.size(), 3); ++i)
    NERITIC_CHECK(!diver::check_table(cases->tables[i], *cases).errors.empty(), "{}",
                  cases->tables[i].id);
  return 0;
}
