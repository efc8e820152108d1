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
#include "engine/core/refusal.hpp"
#include "engine/scene/image_file.hpp"
#include "engine/scene/image_file_limits.hpp"

namespace neritic::scene {
namespace {

// Deflate reaches 1032:1; the wavelet and block codecs of flat pictures a little more. Beyond that
// a header is forged.
constexpr std::uint64_t kMaxRatio = 4096, kRatioSlackBytes = 1 << 20;
constexpr std::size_t kMaxChannels = 64;
constexpr std::uint64_t kMaxCroppedValues = std::uint64_t{1} << 28;  // 1 GiB of floats

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

// The display window's part of what the data window holds, 0 elsewhere: a cropped picture keeps its
// place, so that a pinhole of the whole picture still fits.
ImageF32 in_display(const ImageF32& data, const Imath::Box2i& window, const Imath::Box2i& display) {
  const auto width = static_cast<std::uint32_t>(display.max.x - display.min.x + 1);
  const auto height = static_cast<std::uint32_t>(display.max.y - display.min.y + 1);
  ImageF32 out(width, height, data.channels);
  const int left = std::max(window.min.x, display.min.x),
            right = std::min(window.max.x, display.max.x);
  const int top = std::max(window.min.y, display.min.y),
            bottom = std::min(window.max.y, display.max.y);
  for (int y = top; y <= bottom && left <= right; ++y) {
    const auto at = [&](const ImageF32& image, const Imath::Box2i& box) {
      return (static_cast<std::size_t>(y - box.min.y) * image.width +
              static_cast<std::size_t>(left - box.min.x)) *
             image.channels;
    };
    const std::size_t n = static_cast<std::size_t>(right - left + 1) * data.channels;
    std::copy_n(data.data.begin() + std::ptrdiff_t(at(data, window)), n,
                out.data.begin() + std::ptrdiff_t(at(out, display)));
  }
  return out;
}

struct WindowSize {
  std::int64_t width, height;
};
WindowSize size_of(const Imath::Box2i& window) {
  return {std::int64_t{window.max.x} - window.min.x + 1,
          std::int64_t{window.max.y} - window.min.y + 1};
}

Status check_window(const std::string& name, const WindowSize& size) {
  if (size.width < 1 || size.height < 1 || size.width > kMaxImageSide ||
      size.height > kMaxImageSide ||
      static_cast<std::uint64_t>(size.width * size.height) > kMaxImagePixels)
    return refusal(name, fmt::format("{} x {} pixels", size.width, size.height),
                   fmt::format("at most {} x {} and 2^28 in all", kMaxImageSide, kMaxImageSide));
  return {};
}

Result<ExrImage> read_channels(std::span<const std::byte> bytes, const std::string& name) {
  MemoryStream stream(bytes, name);
  Imf::InputFile file(stream, 0);  // 0: no threads of its own
  const Imath::Box2i window = file.header().dataWindow();
  const Imath::Box2i display = file.header().displayWindow();
  const auto [width, height] = size_of(window);
  const WindowSize whole = size_of(display);
  NERITIC_TRY_STATUS(check_window(name, {width, height}));
  NERITIC_TRY_STATUS(check_window(name, whole));
  if (!window.intersects(display))
    return refusal(
        name, "no pixel in the display window",
        fmt::format("a data window inside its {} x {} pixels", whole.width, whole.height));
  ExrImage out;
  const Imf::ChannelList& channels = file.header().channels();
  for (auto it = channels.begin(); it != channels.end(); ++it) {
    if (it.channel().xSampling != 1 || it.channel().ySampling != 1)
      return refusal(name, fmt::format("the subsampled channel {}", it.name()), "full resolution");
    out.names.emplace_back(it.name());
  }
  const std::uint64_t n_channels = out.names.size();
  if (n_channels < 1 || n_channels > kMaxChannels)
    return refusal(name, fmt::format("{} channels", n_channels),
                   fmt::format("1 to {}", kMaxChannels));
  // A crop to almost nothing is usual, so the file's size says nothing of the display window.
  if (window != display &&
      static_cast<std::uint64_t>(whole.width * whole.height) * n_channels > kMaxCroppedValues)
    return refusal(name,
                   fmt::format("a display window of {} x {} x {} values", whole.width, whole.height,
                               n_channels),
                   "at most 2^28 if the data window differs");
  const std::uint64_t n_bytes =
      static_cast<std::uint64_t>(width * height) * n_channels * sizeof(float);
  if (n_bytes > bytes.size() * kMaxRatio + kRatioSlackBytes)
    return refusal(name, fmt::format("{} x {} x {} values", width, height, n_channels),
                   fmt::format("as many as can come from {} bytes", bytes.size()));
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
  if (window != display) out.image = in_display(out.image, window, display);
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
    return refusal(name, fmt::format("no readable OpenEXR file ({})", reason), "a whole .exr");
  }
}

Result<ExrImage> read_exr(const std::filesystem::path& path) {
  NERITIC_TRY(const auto bytes, read_file(path));
  return decode_exr(bytes, path.string());
}

}  // namespace neritic::scene
