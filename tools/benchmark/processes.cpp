// Measurements that need other processes: start to first picture, and the same bits on one and on
// two threads.
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "engine/core/clock.hpp"
#include "engine/core/files.hpp"
#include "engine/core/hash.hpp"
#include "tools/benchmark/groups.hpp"

namespace neritic::bench {
namespace {

namespace fs = std::filesystem;

// A folder of its own under the system's temporary one, gone at the end.
class Scratch {
 public:
  Scratch() : path_(fs::temp_directory_path() / fmt::format("neritic_bench_{}", getpid())) {
    fs::create_directories(path_);
  }
  ~Scratch() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

fs::path program_folder() {
  return fs::read_symlink("/proc/self/exe").parent_path();
}

// Runs a program with extra environment ("NAME=value"), its output thrown away. Its exit status.
int run_program(const std::vector<std::string>& words,
                const std::vector<std::string>& environment) {
  const pid_t child = fork();
  if (child == 0) {
    for (const std::string& assignment : environment) putenv(const_cast<char*>(assignment.c_str()));
    if (!std::freopen("/dev/null", "w", stdout)) _exit(127);
    std::vector<char*> argv;
    for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    execv(argv[0], argv.data());
    _exit(127);
  }
  int status = -1;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
}

Result<Sample> first_picture(const Suite& suite, const fs::path& out, const fs::path& cache) {
  fs::remove_all(out);
  std::vector<std::string> words{(program_folder() / "neritic").string(),
                                 "render",
                                 suite.options().assets + "/scenes/wreck.toml",
                                 "--sensor",
                                 "overview",
                                 "--out",
                                 out.string()};
  if (!suite.options().device.empty())
    words.insert(words.end(), {"--device", suite.options().device});
  const TimeNs start = now_ns();
  const int status = run_program(words, {"XDG_CACHE_HOME=" + cache.string()});
  const double ms = to_ms(now_ns() - start);
  if (status != 0) return failure(ErrorCode::kIo, "{} ended with {}", words[0], status);
  NERITIC_TRY(const auto picture, read_file(out / "frame_0000/overview/color.png"));
  Hash64 hash;
  hash.add_span(std::span<const std::byte>(picture));
  return Sample{ms, {}, hash.hex()};
}

}  // namespace

Status bench_start(Suite& suite, gpu::Device&) {
  if (!suite.wants("start")) return {};
  const Scratch scratch;
  const fs::path out = scratch.path() / "out", warm = scratch.path() / "warm",
                 cold = scratch.path() / "cold";
  Contender first{"start/first_picture_warm_cache",
                  [&] { return first_picture(suite, out, warm); }};
  Contender fresh{"start/first_picture_no_cache", [&] {
                    fs::remove_all(cold);
                    return first_picture(suite, out, cold);
                  }};
  NERITIC_TRY_STATUS(suite.measure({first, fresh}, 7));
  suite.must_agree(first.name, fresh.name);
  suite.aim_ms("start to first picture, warm cache", first.name, 1500.0);
  return {};
}

Status bench_threads(Suite& suite, const std::string& device_name) {
  if (!suite.wants("threads") || suite.options().once) return {};
  // LP_NUM_THREADS is llvmpipe's own switch; on other devices there is nothing to vary.
  if (device_name.find("llvmpipe") == std::string::npos) return {};
  const Scratch scratch;
  std::map<std::string, std::string> hashes[2];
  for (int i = 0; i < 2; ++i) {
    const std::string json = (scratch.path() / fmt::format("threads_{}.json", i + 1)).string();
    std::vector<std::string> words{(program_folder() / "neritic_bench").string(),
                                   "--once",
                                   "--json",
                                   json,
                                   "--assets",
                                   suite.options().assets};
    if (!suite.options().device.empty())
      words.insert(words.end(), {"--device", suite.options().device});
    if (const int status = run_program(words, {fmt::format("LP_NUM_THREADS={}", i + 1)});
        status != 0)
      return failure(ErrorCode::kIo, "{} --once on {} threads ended with {}", words[0], i + 1,
                     status);
    NERITIC_TRY(hashes[i], read_hashes(json));
  }
  std::size_t equal = 0;
  for (const auto& [name, hash] : hashes[0]) {
    if (hashes[1][name] == hash)
      ++equal;
    else
      suite.fail(fmt::format("{}: {} on one thread, {} on two", name, hash, hashes[1][name]));
    if (const Measured* here = suite.find(name); here && here->hash != hash)
      suite.fail(fmt::format("{}: {} in this run, {} on one thread", name, here->hash, hash));
  }
  suite.note("equal_on_1_and_2_threads", fmt::format("{} of {} results", equal, hashes[0].size()));
  return {};
}

}  // namespace neritic::bench
