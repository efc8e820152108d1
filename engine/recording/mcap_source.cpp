#include <sys/stat.h>

#include <algorithm>
#include <cstdio>

#include "engine/core/refusal.hpp"
#include "engine/recording/mcap_reader.hpp"

namespace neritic::recording {
namespace {

class FileBytes final : public McapSource {
 public:
  FileBytes(std::FILE* file, std::uint64_t size, std::string name)
      : file_(file), size_(size), name_(std::move(name)) {}
  std::uint64_t size() const override { return size_; }
  Status read(std::uint64_t at, std::span<std::byte> out) override {
    if (at != next_ && ::fseeko(file_.get(), static_cast<off_t>(at), SEEK_SET) != 0)
      return failure(ErrorCode::kIo, "{}: byte {} cannot be reached", name_, at);
    next_ = at + out.size();
    if (std::fread(out.data(), 1, out.size(), file_.get()) == out.size()) return {};
    next_ = ~std::uint64_t{0};
    return failure(ErrorCode::kIo, "{}: {} bytes at {} cannot be read", name_, out.size(), at);
  }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> file_;
  std::uint64_t size_, next_ = 0;
  std::string name_;
};

class MemoryBytes final : public McapSource {
 public:
  explicit MemoryBytes(std::span<const std::byte> bytes) : bytes_(bytes) {}
  std::uint64_t size() const override { return bytes_.size(); }
  Status read(std::uint64_t at, std::span<std::byte> out) override {
    std::ranges::copy(bytes_.subspan(static_cast<std::size_t>(at), out.size()), out.begin());
    return {};
  }

 private:
  std::span<const std::byte> bytes_;
};

}  // namespace

Result<std::unique_ptr<McapSource>> open_mcap(const std::filesystem::path& path) {
  std::FILE* file = std::fopen(path.c_str(), "rb");
  struct stat facts {};
  if (file == nullptr)
    return refusal(path.string(), "nothing that may be opened", "a file that can be read");
  if (::fstat(::fileno(file), &facts) != 0 || !S_ISREG(facts.st_mode)) {
    std::fclose(file);
    return refusal(path.string(), "no plain file", "a file that can be read");
  }
  return std::unique_ptr<McapSource>(
      new FileBytes(file, static_cast<std::uint64_t>(facts.st_size), path.string()));
}

std::unique_ptr<McapSource> mcap_of(std::span<const std::byte> bytes) {
  return std::make_unique<MemoryBytes>(bytes);
}

}  // namespace neritic::recording
