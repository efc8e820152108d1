// Reading OpenEXR. See image_file.hpp.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>

#include <algorithm>
#include <cstring>
#include <exception>

#include "engine/core/files.hpp"
#include "engine/scene/image_file.hpp"
#include "engine/scene/image_file_limits.hpp"

namespace neritic::scene {
namespace {

// Deflate reaches 1032:1; the wavelet and block codecs of flat pictures a little more. Beyond that
// a header is forged.
constexpr std::uint64_t kMaxRatio = 4096, kRatioSlackBytes = 1 << 20;
constexpr std::size_t kMaxChannels = 64;

// OpenEXR reads from this instead of a file. Throws as OpenEXR wants it.
class MemoryStream : public Imf::IStream {
 public:
  MemoryStream(std::span<const std::byte> bytes, const std::string& name)
      : IStream(name.c_str()), bytes_(bytes) {}
  bool read(char* out, int n) override {
    if (n < 0 || static_cast<std::uint64_t>(n) > bytes_.size() - at_)
      throw std::runtime_error("the file ends too early");
    std::memcpy(out, bytes_.data() + at_, static_cast<std::size_t>(n));
    at_ += static_cast<std::uint64_t>(n);
    return at_ < bytes_.size();
  }
  std::uint64_t tellg() override { return at_; }
  void seekg(std::uint64_t position) override {
    if (position > bytes_.size()) throw std::runtime_error("an offset beyond the file's end");
    at_ = position;
  }

 private:
  std::span<const std::byte> bytes_;
  std::uint64_t at_ = 0;
};

// "ViewLayer.Normal.X": the part after the last dot is the channel proper.
std::string proper_name(const std::string& name) {
  return name.substr(name.rfind('.') + 1);
}

// R, G, B(, A) or X, Y, Z first, in that order; all else alphabetical.
void sort_channels(std::vector<std::string>& names) {
  const auto rank = [](const std::string& name) {
    const auto at = std::string_view("RGBAXYZ").find(proper_name(name));
    return proper_name(name).size() == 1 && at != std::string_view::npos ? static_cast<int>(at)
                                                                         : 99;
  };
  std::sort(names.begin(), names.end());
  std::stable_sort(names.begin(), names.end(),
                   [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
}

Result<ExrImage> read_channels(std::span<const std::byte> bytes, const std::string& name) {
  MemoryStream stream(bytes, name);
  Imf::InputFile file(stream, 0);  // 0: no threads of its own
  const Imath::Box2i window = file.header().dataWindow();
  const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
  const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
  if (width < 1 || height < 1 || width > kMaxImageSide || height > kMaxImageSide ||
      static_cast<std::uint64_t>(width * height) > kMaxImagePixels)
    return bad_input("{}: {} x {} pixels, at most {} x {} and 2^28 in all are accepted", name,
                     width, height, kMaxImageSide, kMaxImageSide);
  ExrImage out;
  const Imf::ChannelList& channels = file.header().channels();
  for (auto it = channels.begin(); it != channels.end(); ++it) {
    if (it.channel().xSampling != 1 || it.channel().ySampling != 1)
      return bad_input("{}: channel {} is subsampled, full resolution is accepted", name,
                       it.name());
    out.names.emplace_back(it.name());
  }
  const std::uint64_t n_channels = out.names.size();
  if (n_channels < 1 || n_channels > kMaxChannels)
    return bad_input("{}: {} channels, 1 to {} are accepted", name, n_channels, kMaxChannels);
  const std::uint64_t n_bytes =
      static_cast<std::uint64_t>(width * height) * n_channels * sizeof(float);
  if (n_bytes > bytes.size() * kMaxRatio + kRatioSlackBytes)
    return bad_input("{}: {} x {} x {} values cannot come from {} bytes", name, width, height,
                     n_channels, bytes.size());
  sort_channels(out.names);
  out.image = ImageF32(static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height),
                       static_cast<std::uint32_t>(n_channels));
  Imf::FrameBuffer frame;
  for (std::size_t c = 0; c < n_channels; ++c)
    frame.insert(out.names[c],
                 Imf::Slice::Make(Imf::FLOAT, out.image.data.data() + c, window,
                                  n_channels * sizeof(float), n_channels * sizeof(float) * width));
  file.setFrameBuffer(frame);
  file.readPixels(window.min.y, window.max.y);
  return out;
}

}  // namespace

Result<ExrImage> decode_exr(std::span<const std::byte> bytes, const std::string& name) {
  try {
    return read_channels(bytes, name);
  } catch (const std::exception& exception) {  // OpenEXR reports everything this way
    std::string reason = exception.what();
    for (char& c : reason)
      if (static_cast<unsigned char>(c) < 0x20) c = ' ';
    return bad_input("{}: no readable OpenEXR file: {}", name, reason);
  }
}

Result<ExrImage> read_exr(const std::filesystem::path& path) {
  NERITIC_TRY(const auto bytes, read_file(path));
  return decode_exr(bytes, path.string());
}

}  // namespace neritic::scene
