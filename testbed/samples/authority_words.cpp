#include "testbed/samples/authority_words.hpp"

namespace neritic::testbed {
namespace {

std::string source_name(std::uint64_t source, const std::vector<std::string>& sources) {
  return source < sources.size() ? sources[source] : fmt::format("source {}", source);
}

std::string times_words(std::uint64_t times) {
  return times == 1 ? "" : fmt::format(" ({} times so far)", times);
}

}  // namespace

std::string authority_words(const GroupState& state, const std::vector<std::string>& sources) {
  if (state.authority != Authority::kLive) return std::string(name_of(state.authority));
  return "live from " + source_name(state.source, sources);
}

std::string trouble_words(const GroupState& state, const std::vector<std::string>& sources) {
  std::string words;
  if (state.phase == GroupPhase::kWaiting)
    words = fmt::format("{} was never heard, {} acts", source_name(state.source, sources),
                        name_of(state.then));
  else if (state.phase == GroupPhase::kLost)
    words = fmt::format("{} is silent{}, {} acts", source_name(state.source, sources),
                        times_words(state.losses), name_of(state.then));
  if (state.unheeded == 0) return words;
  return words + fmt::format("{}{} sample{} of {} not used, {}", words.empty() ? "" : "; ",
                             state.unheeded, state.unheeded == 1 ? "" : "s",
                             source_name(state.unheeded_source, sources),
                             authority_words(state, sources));
}

}  // namespace neritic::testbed
