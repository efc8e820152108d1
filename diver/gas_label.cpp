#include "diver/gas_label.hpp"

#include <charconv>
#include <cmath>

#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"

namespace neritic::diver {
namespace {

constexpr double kLeastO2_percent = 1.0;

// The whole of text as a number of percent.
bool read_percent(std::string_view text, double& percent) {
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), percent);
  return fault == std::errc() && end == text.data() + text.size() && std::isfinite(percent);
}

Error no_mix(std::string_view text) {
  return refusal("", fmt::format("gas '{}'", text.substr(0, 40)),
                 "air, o2, ean32 (1 to 100) or 18/45 (oxygen/helium)");
}

}  // namespace

GasMix mix_of_percent(double o2, double he) {
  return {o2 / 100.0, he / 100.0};
}

Result<GasMix> parse_mix(std::string_view text) {
  std::string rest = lower_case(text);
  if (rest == "air") return kAir;
  if (rest == "o2" || rest == "oxygen") return GasMix{1.0, 0.0};
  for (const char* prefix : {"ean", "nitrox", "nx", "trimix", "tx"})
    if (rest.starts_with(prefix)) {
      rest.erase(0, std::string_view(prefix).size());
      break;
    }
  double o2 = 0.0, he = 0.0;
  const std::size_t slash = rest.find('/');
  if (!read_percent(rest.substr(0, slash), o2)) return no_mix(text);
  if (slash != rest.npos && !read_percent(rest.substr(slash + 1), he)) return no_mix(text);
  if (!(o2 >= kLeastO2_percent && he >= 0.0 && o2 + he <= 100.0)) return no_mix(text);
  return mix_of_percent(o2, he);
}

std::string name_of(const GasMix& mix) {
  const double o2 = 100.0 * mix.oxygen, he = 100.0 * mix.helium;
  // As many digits as labels have.
  const auto tidy = [](double percent) { return fmt::format("{:.4g}", percent); };
  if (he > 0.0) return tidy(o2) + "/" + tidy(he);
  if (mix.oxygen == kAir.oxygen) return "air";
  if (mix.oxygen == 1.0) return "O2";
  return "EAN" + tidy(o2);
}

}  // namespace neritic::diver
