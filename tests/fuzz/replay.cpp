// Runs a fuzz target without libFuzzer: first every file it is given (folders recursively), then
// mutations of them until the time is over. Mutation k depends on the seed, k and the files alone,
// so
// "--only k" repeats the one that a failure names.
//   fuzz_gltf [--seconds S] [--seed N] [--only K] FILE_OR_FOLDER...
#include "tests/fuzz/replay.hpp"

#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/core/files.hpp"
#include "engine/core/random.hpp"

namespace {
namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t kLargestInput = 1 << 20;  // larger files are replayed, not mutated
constexpr double kSlow_s = 10.0;                // one input longer than this counts as a hang

char running[256] = "nothing";  // for the signal handler: what runs now

// Processor time: what else the machine does takes no mutations away.
double spent_s() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

void say_what_ran(int signal) {
  const char before[] = "\nwhile running ";
  (void)!::write(2, before, sizeof before - 1);
  (void)!::write(2, running, std::strlen(running));
  (void)!::write(2, "\n", 1);
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

struct Random {
  neritic::RandomKey key;
  std::uint64_t index = 0;
  std::uint64_t below(std::uint64_t n) { return neritic::random_bits(key, index++) % n; }
};

void overwrite_number(Bytes& bytes, Random& random) {
  static constexpr std::uint64_t kNumbers[] = {
      0,          1,          0x7f,       0x80,       0xff,  0x7fff,  0xffff, 0x7fffffff,
      0x80000000, 0xffffffff, 0x7f800000, 0x7fc00000, 0x100, 0x10000, 3};
  const std::uint64_t number = kNumbers[random.below(std::size(kNumbers))];
  const std::size_t size = std::size_t{1} << random.below(4);
  if (bytes.size() < size) return;
  std::memcpy(bytes.data() + random.below(bytes.size() - size + 1), &number, size);
}

// Replaces a decimal number in text, the usual way to break JSON without breaking its grammar.
void change_text_number(Bytes& bytes, Random& random) {
  static constexpr const char* kTexts[] = {"0",     "1",          "-1",   "7",   "255",
                                           "65536", "4294967295", "1e30", "0.5", "5126"};
  const auto digit = [](std::uint8_t c) { return c >= '0' && c <= '9'; };
  const std::size_t start = random.below(bytes.size());
  const auto from =
      std::find_if(bytes.begin() + static_cast<std::ptrdiff_t>(start), bytes.end(), digit);
  const auto to = std::find_if_not(from, bytes.end(), digit);
  const std::string text = kTexts[random.below(std::size(kTexts))];
  const auto at = bytes.erase(from, to);
  bytes.insert(at, text.begin(), text.end());
}

void copy_range(Bytes& bytes, const Bytes& other, Random& random) {
  if (other.empty()) return;
  const std::size_t from = random.below(other.size());
  const std::size_t length = 1 + random.below(std::min<std::size_t>(other.size() - from, 64));
  const std::size_t at = random.below(bytes.size() + 1);
  bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at),
               other.begin() + static_cast<std::ptrdiff_t>(from),
               other.begin() + static_cast<std::ptrdiff_t>(from + length));
}

void erase_range(Bytes& bytes, Random& random) {
  const std::size_t from = random.below(bytes.size());
  const std::size_t length = 1 + random.below(std::min<std::size_t>(bytes.size() - from, 64));
  bytes.erase(bytes.begin() + static_cast<std::ptrdiff_t>(from),
              bytes.begin() + static_cast<std::ptrdiff_t>(from + length));
}

Bytes mutated(const std::vector<Bytes>& seeds, std::uint64_t seed, std::uint64_t k) {
  Random random{{seed, 0x66757a7a, k}};
  Bytes bytes = seeds[random.below(seeds.size())];
  const std::uint64_t n_steps = 1 + random.below(6);
  for (std::uint64_t step = 0; step < n_steps; ++step) {
    if (bytes.empty()) bytes.push_back(0);
    switch (random.below(7)) {
      case 0:
        bytes[random.below(bytes.size())] ^= std::uint8_t(1u << random.below(8));
        break;
      case 1:
        bytes[random.below(bytes.size())] = static_cast<std::uint8_t>(random.below(256));
        break;
      case 2:
        overwrite_number(bytes, random);
        break;
      case 3:
        change_text_number(bytes, random);
        break;
      case 4:
        erase_range(bytes, random);
        break;
      case 5:
        copy_range(bytes, seeds[random.below(seeds.size())], random);
        break;
      case 6:
        if (random.below(4) == 0) bytes.resize(random.below(bytes.size() + 1));
        break;
    }
  }
  return bytes;
}

void run(const Bytes& bytes, const std::string& what) {
  std::snprintf(running, sizeof running, "%s (%zu bytes)", what.c_str(), bytes.size());
  const double start_s = spent_s();
  LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
  const double took_s = spent_s() - start_s;
  if (took_s < kSlow_s) return;
  std::fprintf(stderr, "%s took %.1f s\n", running, took_s);
  std::abort();
}

std::vector<fs::path> files_below(const std::vector<std::string>& arguments) {
  std::vector<fs::path> files;
  for (const std::string& argument : arguments) {
    if (!fs::is_directory(argument))
      files.emplace_back(argument);
    else
      for (const auto& entry : fs::recursive_directory_iterator(argument))
        if (entry.is_regular_file()) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());  // the order of a folder is the file system's
  return files;
}

}  // namespace

int main(int argc, char** argv) {
  double seconds = 3.0;
  std::uint64_t seed = 1, only = UINT64_MAX;
  std::vector<std::string> arguments;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--seconds" && i + 1 < argc)
      seconds = std::atof(argv[++i]);
    else if (argument == "--seed" && i + 1 < argc)
      seed = std::strtoull(argv[++i], nullptr, 10);
    else if (argument == "--only" && i + 1 < argc)
      only = std::strtoull(argv[++i], nullptr, 10);
    else
      arguments.push_back(argument);
  }
  std::signal(SIGABRT, say_what_ran);
  std::signal(SIGSEGV, say_what_ran);

  std::vector<Bytes> seeds;
  for (const fs::path& file : files_below(arguments)) {
    const auto content = neritic::read_file(file);
    if (!content.ok()) {
      std::fprintf(stderr, "%s\n", content.error().message.c_str());
      return 2;
    }
    const auto* data = reinterpret_cast<const std::uint8_t*>(content->data());
    Bytes bytes(data, data + content->size());
    if (only == UINT64_MAX) run(bytes, file.string());
    if (bytes.size() <= kLargestInput) seeds.push_back(std::move(bytes));
  }
  if (seeds.empty()) {
    std::fprintf(stderr, "no files to start from\n");
    return 2;
  }
  const std::size_t n_files = seeds.size();
  std::uint64_t k = only == UINT64_MAX ? 0 : only;
  const double end_s = spent_s() + seconds;
  for (; only != UINT64_MAX ? k == only : spent_s() < end_s; ++k)
    run(mutated(seeds, seed, k), "mutation " + std::to_string(k));
  std::printf("%zu files, %llu mutations\n", n_files, static_cast<unsigned long long>(k));
  return 0;
}
