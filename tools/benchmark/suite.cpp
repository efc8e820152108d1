#include "tools/benchmark/suite.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/core/files.hpp"
#include "engine/core/json.hpp"

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

// Counts are doubles here and whole numbers there.
nlohmann::json json_of(double value) {
  return value == std::floor(value) ? nlohmann::json(static_cast<std::int64_t>(value))
                                    : nlohmann::json(value);
}
nlohmann::json json_of(const std::string& text) {
  return text;
}
nlohmann::json json_of(const std::vector<double>& values) {
  nlohmann::json list = nlohmann::json::array();
  for (const double value : values) list.push_back(json_of(value));
  return list;
}
nlohmann::json json_of(const Fact& fact) {
  return std::visit([](const auto& value) { return json_of(value); }, fact);
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
  ratios_[name] = {a->min_ms() / b->min_ms(), a->median_ms() / b->median_ms()};
}

void Suite::must_agree(const std::string& a, const std::string& b) {
  const Measured *x = find(a), *y = find(b);
  if (!x || !y) return;
  if (x->hash != y->hash)
    fail(fmt::format("{} gives {}, {} gives {}: they must be the same", a, x->hash, b, y->hash));
}

void Suite::aim_ms(const std::string& what, const std::string& result, double limit_ms) {
  if (const Measured* m = find(result))
    aims_.push_back({what, "ms", m->median_ms(), limit_ms, true});
}

void Suite::aim_most(const std::string& what, const std::string& unit, double reached,
                     double at_most) {
  aims_.push_back({what, unit, reached, at_most, true});
}

void Suite::aim_ratio(const std::string& what, const std::string& ratio, double at_least) {
  if (const auto at = ratios_.find(ratio); at != ratios_.end())
    aims_.push_back({what, "times", at->second.of_least, at_least, false});
}

Status Suite::write(const std::string& file, const std::string& device, unsigned threads) const {
  nlohmann::json results = nlohmann::json::array();
  for (const Measured& m : results_) {
    nlohmann::json one{{"name", m.name},       {"median_ms", m.median_ms()},
                       {"min_ms", m.min_ms()}, {"cpu_ms", median(m.cpu_ms)},
                       {"n", m.ms.size()},     {"hash", m.hash}};
    for (const auto& [name, values] : m.parts) one["parts_ms"][name] = median(values);
    for (const auto& [name, fact] : m.facts) one[name] = json_of(fact);
    results.push_back(std::move(one));
  }
  nlohmann::json ratios = nlohmann::json::object(), of_medians = ratios, facts = ratios;
  for (const auto& [name, ratio] : ratios_) {
    ratios[name] = ratio.of_least;
    of_medians[name] = ratio.of_medians;
  }
  for (const auto& [name, fact] : facts_) facts[name] = json_of(fact);
  nlohmann::json aims = nlohmann::json::array();
  for (const Aim& a : aims_)
    aims.push_back({{"what", a.what},
                    {"reached", a.reached},
                    {a.at_most ? "at_most" : "at_least", a.limit},
                    {"unit", a.unit},
                    {"met", a.met()}});
  return write_json(file, {{"device", device},
                           {"threads", threads},
                           {"results", results},
                           {"ratios", ratios},
                           {"ratios_of_medians", of_medians},
                           {"facts", facts},
                           {"aims", aims},
                           {"failures", failures_}});
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
  for (const auto& [name, ratio] : ratios_)
    fmt::print("{:<44} {:>10.2f} {:>10.2f}\n", name, ratio.of_least, ratio.of_medians);
  for (const auto& [name, fact] : facts_)
    fmt::print("{:<44} {:>10}\n", name, json_text(json_of(fact), -1));
  if (!aims_.empty()) fmt::print("\n");
  for (const Aim& a : aims_)
    fmt::print("{:<44} {:>10.3f} {} (aim: {} {}) {}\n", a.what, a.reached, a.unit,
               a.at_most ? "at most" : "at least", a.limit, a.met() ? "met" : "MISSED");
  for (const std::string& failure : failures_) fmt::print("FAILED: {}\n", failure);
}

Result<std::map<std::string, std::string>> read_hashes(const std::string& file) {
  NERITIC_TRY(const std::string text, read_text(file));
  NERITIC_TRY(const nlohmann::json parsed, parse_json(text));
  std::map<std::string, std::string> hashes;
  for (const nlohmann::json& result : parsed["results"])
    hashes[result["name"].get<std::string>()] = result["hash"].get<std::string>();
  return hashes;
}

}  // namespace neritic::bench
