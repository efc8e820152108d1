// The program `neritic_bench`; tools/bench builds and runs it.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "engine/core/files.hpp"
#include "tools/benchmark/groups.hpp"

namespace neritic::bench {
namespace {

unsigned thread_count() {
  if (const char* text = std::getenv("LP_NUM_THREADS"))
    return static_cast<unsigned>(std::atoi(text));
  return std::thread::hardware_concurrency();
}

Status run(Suite& suite) {
  gpu::DeviceOptions options;
  options.device = suite.options().device;
  options.cache_folder = gpu::default_cache_folder();
  NERITIC_TRY(const auto device, gpu::Device::create(options));
  NERITIC_TRY_STATUS(bench_sonar_binning(suite, *device));
  NERITIC_TRY_STATUS(bench_sonar_frame(suite, *device));
  NERITIC_TRY_STATUS(bench_camera_frame(suite, *device));
  NERITIC_TRY_STATUS(bench_sweeps(suite, *device));
  if (!suite.options().once) NERITIC_TRY_STATUS(bench_start(suite, *device));
  NERITIC_TRY_STATUS(bench_threads(suite, device->info().name));
  fmt::print("{}, {} threads\n\n", device->info().name, thread_count());
  suite.print();
  if (suite.options().json.empty()) return {};
  return write_text(suite.options().json,
                    suite.to_json(device->info().name, thread_count()).dump(2) + "\n");
}

int main_of(int argc, char** argv) {
  Options options;
  CLI::App app{"Measures Neritic, checks that results keep their bits", "neritic_bench"};
  app.add_option("--json", options.json, "also write the results to this file");
  app.add_option("--filter", options.filter,
                 "only groups whose name holds this: sonar_binning, sonar_frame, camera_frame, "
                 "sweep, start, threads");
  app.add_option("--device", options.device, "Vulkan device: index or part of its name");
  app.add_option("--assets", options.assets, "the folder that holds scenes/");
  app.add_flag("--quick", options.quick, "few rounds");
  app.add_flag("--sweep", options.sweep, "also cost against bins, pixels and triangles");
  app.add_flag("--once", options.once, "one round of each, in this process only");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    std::fprintf(stderr, "neritic_bench: %s (see neritic_bench --help)\n", error.what());
    return 2;
  }
  Suite suite(options);
  if (const Status status = run(suite); !status.ok()) {
    std::fprintf(stderr, "neritic_bench: %s\n", status.error().message.c_str());
    return exit_status(status.error().code);
  }
  return suite.failures().empty() ? 0 : 1;
}

}  // namespace
}  // namespace neritic::bench

int main(int argc, char** argv) {
  return neritic::bench::main_of(argc, argv);
}
