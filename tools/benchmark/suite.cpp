#include "tools/benchmark/suite.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>

namespace neritic::bench {
namespace {

constexpr double kLongest_ms = 20000.0;  // of all rounds of one group
constexpr int kFewest = 5, kQuick = 7;

// Time that all threads of this process and of its ended children spent on a core: other programs
// on the machine move it little.
double process_cpu_ms() {
  double ms = 0.0;
  for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage usage{};
    getrusage(who, &usage);
    for (const timeval& t : {usage.ru_utime, usage.ru_stime})
      ms += static_cast<double>(t.tv_sec) * 1e3 + static_cast<double>(t.tv_usec) * 1e-3;
  }
  return ms;
}

Status run_untimed(const Contender& contender) {
  const Result<Sample> sample = contender.run();
  return sample.ok() ? Status{} : Status{sample.error()};
}

}  // namespace

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const std::size_t middle = values.size() / 2;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(middle),
                   values.end());
  const double upper = values[middle];
  if (values.size() % 2 == 1) return upper;
  const double lower =
      *std::max_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(middle));
  return 0.5 * (lower + upper);
}

double Measured::median_ms() const {
  return median(ms);
}
double Measured::min_ms() const {
  return ms.empty() ? 0.0 : *std::min_element(ms.begin(), ms.end());
}

bool Suite::wants(const std::string& group) const {
  const std::string& filter = options_.filter;
  return filter.empty() || group.find(filter) != std::string::npos ||
         filter.rfind(group + "/", 0) == 0;
}

Status Suite::measure(std::vector<Contender> contenders, int rounds) {
  if (options_.filter.find('/') != std::string::npos)
    std::erase_if(contenders, [&](const Contender& c) {
      return c.name.find(options_.filter) == std::string::npos;
    });
  std::vector<Measured> measured;
  double round_ms = 0.0;
  // The warm-up: pipelines, first touches of memory. Its result counts, its time does not.
  for (const Contender& c : contenders) {
    NERITIC_TRY(const Sample sample, c.run());
    measured.push_back({c.name, sample.hash, {}, {}, {}, c.facts});
    round_ms += sample.ms;
  }
  if (options_.quick) rounds = std::min(rounds, kQuick);
  rounds = std::clamp(static_cast<int>(kLongest_ms / std::max(round_ms, 1e-3)),
                      std::min(kFewest, rounds), rounds);
  if (options_.once) rounds = 1;
  for (int round = 0; round < rounds; ++round)
    for (std::size_t i = 0; i < contenders.size(); ++i) {
      if (contenders[i].warm) NERITIC_TRY_STATUS(run_untimed(contenders[i]));
      const double cpu_before_ms = process_cpu_ms();
      NERITIC_TRY(const Sample sample, contenders[i].run());
      measured[i].cpu_ms.push_back(process_cpu_ms() - cpu_before_ms);
      measured[i].ms.push_back(sample.ms);
      for (const auto& [name, ms] : sample.parts) measured[i].parts[name].push_back(ms);
      if (sample.hash != measured[i].hash)
        fail(fmt::format("{}: the result of round {} differs: {}, before {}", measured[i].name,
                         round, sample.hash, measured[i].hash));
    }
  results_.insert(results_.end(), measured.begin(), measured.end());
  return {};
}

const Measured* Suite::find(const std::string& name) const {
  const auto at = std::find_if(results_.begin(), results_.end(),
                               [&](const Measured& m) { return m.name == name; });
  return at == results_.end() ? nullptr : &*at;
}

void Suite::ratio(const std::string& name, const std::string& numerator,
                  const std::string& denominator) {
  const Measured *a = find(numerator), *b = find(denominator);
  if (!a || !b || b->min_ms() <= 0.0) return;
  ratios_[name] = a->min_ms() / b->min_ms();
  median_ratios_[name] = a->median_ms() / b->median_ms();
}

void Suite::must_agree(const std::string& a, const std::string& b) {
  const Measured *x = find(a), *y = find(b);
  if (!x || !y) return;
  if (x->hash != y->hash)
    fail(fmt::format("{} gives {}, {} gives {}: they must be the same", a, x->hash, b, y->hash));
}

void Suite::aim(const std::string& what, double reached, double limit, bool at_most,
                const std::string& unit) {
  aims_.push_back({{"what", what},
                   {"reached", reached},
                   {at_most ? "at_most" : "at_least", limit},
                   {"unit", unit},
                   {"met", at_most ? reached <= limit : reached >= limit}});
}

void Suite::aim_ms(const std::string& what, const std::string& result, double limit_ms) {
  if (const Measured* m = find(result)) aim(what, m->median_ms(), limit_ms, true, "ms");
}

void Suite::aim_ratio(const std::string& what, const std::string& ratio, double at_least) {
  if (ratios_.contains(ratio)) aim(what, ratios_[ratio].get<double>(), at_least, false, "times");
}

nlohmann::json Suite::to_json(const std::string& device, unsigned threads) const {
  nlohmann::json results = nlohmann::json::array();
  for (const Measured& m : results_) {
    nlohmann::json one{{"name", m.name},       {"median_ms", m.median_ms()},
                       {"min_ms", m.min_ms()}, {"cpu_ms", median(m.cpu_ms)},
                       {"n", m.ms.size()},     {"hash", m.hash}};
    for (const auto& [name, values] : m.parts) one["parts_ms"][name] = median(values);
    one.update(m.facts);
    results.push_back(std::move(one));
  }
  return {{"device", device},
          {"threads", threads},
          {"results", results},
          {"ratios", ratios_},
          {"ratios_of_medians", median_ratios_},
          {"facts", facts_},
          {"aims", aims_},
          {"failures", failures_}};
}

void Suite::print() const {
  fmt::print("{:<44} {:>10} {:>10} {:>10} {:>4}  {}\n", "", "median ms", "min ms", "cpu ms", "n",
             "hash");
  for (const Measured& m : results_) {
    fmt::print("{:<44} {:>10.3f} {:>10.3f} {:>10.3f} {:>4}  {}\n", m.name, m.median_ms(),
               m.min_ms(), median(m.cpu_ms), m.ms.size(), m.hash);
    for (const auto& [name, values] : m.parts)
      fmt::print("    {:<40} {:>10.3f} {:>10.3f}\n", name, median(values),
                 *std::min_element(values.begin(), values.end()));
  }
  if (!ratios_.empty()) fmt::print("\n{:<44} {:>10} {:>10}\n", "ratios", "of least", "of medians");
  for (const auto& [name, value] : ratios_.items())
    fmt::print("{:<44} {:>10.2f} {:>10.2f}\n", name, value.get<double>(),
               median_ratios_[name].get<double>());
  for (const auto& [name, value] : facts_.items())
    fmt::print("{:<44} {:>10}\n", name, value.dump());
  if (!aims_.empty()) fmt::print("\n");
  for (const nlohmann::json& a : aims_) {
    const bool at_most = a.contains("at_most");
    fmt::print("{:<44} {:>10.3f} {} (aim: {} {}) {}\n", a["what"].get<std::string>(),
               a["reached"].get<double>(), a["unit"].get<std::string>(),
               at_most ? "at most" : "at least", a[at_most ? "at_most" : "at_least"].get<double>(),
               a["met"].get<bool>() ? "met" : "MISSED");
  }
  for (const std::string& failure : failures_) fmt::print("FAILED: {}\n", failure);
}

}  // namespace neritic::bench
