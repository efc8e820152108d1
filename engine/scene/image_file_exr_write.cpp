// Writing OpenEXR: three channels of half floats, compressed without loss. See image_file.hpp.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>

#include <cstring>
#include <exception>

#include "engine/core/check.hpp"
#include "engine/core/files.hpp"
#include "engine/scene/image_file.hpp"

namespace neritic::scene {
namespace {

// OpenEXR writes into this instead of a file, so that a file is whole or not there.
class MemorySink : public Imf::OStream {
 public:
  explicit MemorySink(const std::string& name) : OStream(name.c_str()) {}
  void write(const char* from, int n) override {
    const auto count = static_cast<std::size_t>(n);
    if (at_ + count > bytes.size()) bytes.resize(at_ + count);
    std::memcpy(bytes.data() + at_, from, count);
    at_ += count;
  }
  std::uint64_t tellp() override { return at_; }
  void seekp(std::uint64_t position) override { at_ = position; }
  std::vector<std::byte> bytes;

 private:
  std::uint64_t at_ = 0;
};

}  // namespace

Status write_exr(const std::filesystem::path& path, const ImageF32& image) {
  NERITIC_CHECK(image.channels == 3 && !image.empty(), "{} channels", image.channels);
  std::vector<Imath::half> halves(image.data.begin(), image.data.end());
  MemorySink sink(path.string());
  try {
    Imf::Header header(static_cast<int>(image.width), static_cast<int>(image.height));
    header.compression() = Imf::ZIP_COMPRESSION;
    Imf::FrameBuffer frame;
    const char* names[] = {"R", "G", "B"};
    for (std::size_t c = 0; c < 3; ++c) {
      header.channels().insert(names[c], Imf::Channel(Imf::HALF));
      frame.insert(names[c], Imf::Slice::Make(Imf::HALF, halves.data() + c, header.dataWindow(),
                                              3 * sizeof(Imath::half),
                                              3 * sizeof(Imath::half) * image.width));
    }
    Imf::OutputFile file(sink, header, 0);  // 0: no threads of its own
    file.setFrameBuffer(frame);
    file.writePixels(static_cast<int>(image.height));
  } catch (const std::exception& exception) {
    return failure(ErrorCode::kIo, "{}: {}", path.string(), exception.what());
  }
  return write_file(path, sink.bytes);
}

}  // namespace neritic::scene
