// The program `neritic_bench`; tools/bench builds and runs it.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "engine/core/memory.hpp"
#include "engine/core/text.hpp"
#include "tools/benchmark/groups.hpp"

namespace neritic::bench {
namespace {

unsigned thread_count() {
  if (const char* text = std::getenv("LP_NUM_THREADS"))
    return static_cast<unsigned>(std::atoi(text));
  return std::thread::hardware_concurrency();
}

// That some group will run.
Status check_filter(const Suite& suite) {
  const Options& o = suite.options();
  std::vector<std::string_view> groups(std::begin(kGroups), std::end(kGroups));
  if (!o.sweep) std::erase(groups, "sweep");
  if (o.once) {
    groups.erase(groups.end() - kGroupsWithoutDevice, groups.end());
    std::erase_if(groups, [](auto name) { return name == "start" || name == "threads"; });
  }
  if (std::ranges::any_of(groups, [&](auto name) { return suite.wants(std::string(name)); }))
    return {};
  return bad_input("--filter: '{}' found; accepted: {}{}, or one GROUP/NAME", o.filter,
                   join(groups), o.sweep ? "" : " (with --sweep also sweep)");
}

// These never differ by the device's threads, which is all that --once is for.
Status run_without_device(Suite& suite) {
  if (suite.options().once) return {};
  NERITIC_TRY_STATUS(bench_physics(suite));
  NERITIC_TRY_STATUS(bench_physics_fleet(suite));
  NERITIC_TRY_STATUS(bench_diver(suite));
  return bench_contacts(suite);
}

// name: of the device, where one is needed.
Status run_on_device(Suite& suite, std::string& name) {
  const auto last = std::end(kGroups) - kGroupsWithoutDevice;
  if (std::none_of(std::begin(kGroups), last,
                   [&](auto group) { return suite.wants(std::string(group)); }))
    return {};
  gpu::DeviceOptions options;
  options.device = suite.options().device;
  options.cache_folder = gpu::default_cache_folder();
  NERITIC_TRY(const auto device, gpu::Device::create(options));
  NERITIC_TRY_STATUS(bench_sonar_binning(suite, *device));
  NERITIC_TRY_STATUS(bench_sonar_frame(suite, *device));
  NERITIC_TRY_STATUS(bench_sonar_terms(suite, *device));
  NERITIC_TRY_STATUS(bench_camera_frame(suite, *device));
  NERITIC_TRY_STATUS(bench_picture_terms(suite, *device));
  NERITIC_TRY_STATUS(bench_sweeps(suite, *device));
  NERITIC_TRY_STATUS(bench_deco(suite));
  if (!suite.options().once) NERITIC_TRY_STATUS(bench_start(suite, *device));
  name = device->info().name;
  return bench_threads(suite, name);
}

Status run(Suite& suite) {
  std::string device = "no device";
  NERITIC_TRY_STATUS(check_filter(suite));
  NERITIC_TRY_STATUS(run_without_device(suite));
  NERITIC_TRY_STATUS(run_on_device(suite, device));
  const std::string& filter = suite.options().filter;
  if (filter.find('/') != filter.npos && suite.results().empty())
    return bad_input("--filter: '{}' found; accepted: a GROUP/NAME of the table without --filter",
                     filter);
  fmt::print("{}, {} threads\n\n", device, thread_count());
  suite.print();
  if (suite.options().json.empty()) return {};
  return suite.write(suite.options().json, device, thread_count());
}

// A flag takes either a text or nothing. Read here and not by CLI11, whose header alone would take
// longer to compile than all of this program.
struct Flag {
  const char *name, *help;
  std::string Options::*text = nullptr;
  bool Options::*on = nullptr;
};

constexpr Flag kFlags[] = {
    {"--json", "also write the results to this file", &Options::json},
    {"--filter",
     "only groups whose name holds this: sonar_binning, sonar_frame, sonar_terms, camera_frame,\n"
     "             picture_terms, sweep, deco, start, threads, physics, contacts, diver; or one "
     "GROUP/NAME",
     &Options::filter},
    {"--device", "Vulkan device: index or part of its name", &Options::device},
    {"--assets", "the folder that holds scenes/", &Options::assets},
    {"--quick", "few rounds", nullptr, &Options::quick},
    {"--sweep", "also cost against bins, pixels and triangles", nullptr, &Options::sweep},
    {"--once", "one round of each, in this process only", nullptr, &Options::once},
};

void print_help() {
  fmt::print("Measures Neritic, checks that results keep their bits\n\nneritic_bench [FLAGS]\n");
  for (const Flag& flag : kFlags) fmt::print("  {:<10} {}\n", flag.name, flag.help);
}

Result<Options> parse(std::span<char* const> words) {
  Options options;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string word = words[i];
    const auto flag = std::find_if(std::begin(kFlags), std::end(kFlags),
                                   [&](const Flag& f) { return word == f.name; });
    if (flag == std::end(kFlags))
      return bad_input("'{}' is no flag (see neritic_bench --help)", word);
    if (flag->on) {
      options.*flag->on = true;
      continue;
    }
    if (++i == words.size()) return bad_input("{} needs a value (see neritic_bench --help)", word);
    options.*flag->text = words[i];
  }
  return options;
}

int fail(const Error& error) {
  std::fprintf(stderr, "neritic_bench: %s\n", error.message.c_str());
  return exit_status(error.code);
}

int main_of(std::span<char* const> words) {
  for (const std::string_view word : words)
    if (word == "--help" || word == "-h") {
      print_help();
      return 0;
    }
  const Result<Options> options = parse(words);
  if (!options.ok()) return fail(options.error());
  Suite suite(*options);
  if (const Status status = run(suite); !status.ok()) return fail(status.error());
  return suite.failures().empty() ? 0 : 1;
}

}  // namespace
}  // namespace neritic::bench

int main(int argc, char** argv) {
  neritic::keep_freed_memory();
  return neritic::bench::main_of({argv + 1, argv + argc});
}
