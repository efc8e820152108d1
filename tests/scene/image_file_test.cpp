// Pictures and maps: what is written reads back; other programs' files; forged and cut files.
#include "engine/scene/image_file.hpp"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <gtest/gtest.h>
#include <half.h>
#include <zlib.h>

#include <cmath>
#include <cstring>

#include "engine/core/files.hpp"
#include "engine/core/npy.hpp"
#include "engine/core/random.hpp"
#include "tests/support/support.hpp"

namespace neritic::scene {
namespace {

template <class T>
Raster<T> noise(std::uint32_t width, std::uint32_t height, std::uint32_t channels) {
  Raster<T> image(width, height, channels);
  for (std::size_t i = 0; i < image.data.size(); ++i)
    image.data[i] = static_cast<T>(random_bits({7, channels, 0}, i));
  return image;
}

std::span<const std::byte> bytes_of(const std::vector<unsigned char>& v) {
  return std::as_bytes(std::span(v.data(), v.size()));
}

TEST(ImageFile, EightBitPicturesReadBackExactly) {
  const test::ScratchFolder folder;
  for (const std::uint32_t channels : {1u, 3u, 4u}) {
    const ImageU8 image = noise<std::uint8_t>(37, 11, channels);
    ASSERT_TRUE(write_png8(folder / "a.png", image).ok());
    const auto read = read_image8(folder / "a.png");
    ASSERT_TRUE(read.ok()) << read.error().message;
    EXPECT_EQ(read->width, 37u);
    EXPECT_EQ(read->channels, channels);
    EXPECT_EQ(read->data, image.data);
    EXPECT_FALSE(is_png16(folder / "a.png"));
  }
}

TEST(ImageFile, SixteenBitPicturesReadBackExactly) {
  const test::ScratchFolder folder;
  for (const std::uint32_t channels : {1u, 3u, 4u}) {
    const ImageU16 image = noise<std::uint16_t>(19, 23, channels);
    ASSERT_TRUE(write_png16(folder / "a.png", image).ok());
    EXPECT_TRUE(is_png16(folder / "a.png"));
    const auto read = read_image16(folder / "a.png");
    ASSERT_TRUE(read.ok()) << read.error().message;
    EXPECT_EQ(read->channels, channels);
    EXPECT_EQ(read->data, image.data);
  }
}

TEST(ImageFile, TheSamePixelsGiveTheSameBytes) {
  const test::ScratchFolder folder;
  const ImageU8 image = noise<std::uint8_t>(300, 200, 3);
  ASSERT_TRUE(write_png8(folder / "a.png", image).ok());
  ASSERT_TRUE(write_png8(folder / "b.png", image).ok());
  EXPECT_EQ(*read_file(folder / "a.png"), *read_file(folder / "b.png"));
}

TEST(ImageFile, ChannelsAreConvertedAsAsked) {
  const test::ScratchFolder folder;
  ImageU8 image(2, 1, 3);
  image.data = {10, 20, 30, 200, 100, 0};
  ASSERT_TRUE(write_png8(folder / "a.png", image).ok());
  const auto read = read_image8(folder / "a.png", 4);
  ASSERT_TRUE(read.ok());
  EXPECT_EQ(read->data, (std::vector<std::uint8_t>{10, 20, 30, 255, 200, 100, 0, 255}));
}

TEST(ImageFile, AnEightBitFileIsNoSixteenBitFile) {
  const test::ScratchFolder folder;
  ASSERT_TRUE(write_png8(folder / "a.png", ImageU8(4, 4, 1)).ok());
  const auto read = read_image16(folder / "a.png");
  ASSERT_FALSE(read.ok());
  EXPECT_NE(read.error().message.find("8 bits a channel"), std::string::npos);
  EXPECT_NE(read.error().message.find("a.png"), std::string::npos);
}

TEST(ImageFile, PicturesWithoutPixelsAndUnwritableFoldersAreErrors) {
  const test::ScratchFolder folder;
  const auto empty = write_png8(folder / "a.png", ImageU8());
  ASSERT_FALSE(empty.ok());
  EXPECT_FALSE(std::filesystem::exists(folder / "a.png"));
  EXPECT_FALSE(write_png8(folder / "none/a.png", ImageU8(1, 1, 1)).ok());
}

TEST(ImageFile, EveryCutOfAPngIsAnErrorOrAPictureOfTheSameSize) {
  const test::ScratchFolder folder;
  ASSERT_TRUE(write_png8(folder / "a.png", noise<std::uint8_t>(16, 16, 3)).ok());
  const auto bytes = *read_file(folder / "a.png");
  for (std::size_t length = 0; length + 20 < bytes.size(); ++length) {
    const auto read = decode_image8(std::span(bytes).first(length), "cut.png");
    EXPECT_FALSE(read.ok()) << length;
    if (read.ok()) continue;
    EXPECT_EQ(read.error().message.rfind("cut.png: ", 0), 0u);
  }
}

// CRC-32 of a PNG chunk (PNG specification, annex D), bit by bit.
std::uint32_t crc32_of(std::span<const std::byte> bytes) {
  std::uint32_t crc = 0xffffffffu;
  for (const std::byte b : bytes) {
    crc ^= std::to_integer<std::uint32_t>(b);
    for (int i = 0; i < 8; ++i) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0u);
  }
  return ~crc;
}

// A PNG header that claims 30000 x 8000 pixels in 60 bytes must be refused before memory is asked
// for.
TEST(ImageFile, ForgedHeadersAreRefused) {
  const test::ScratchFolder folder;
  ASSERT_TRUE(write_png8(folder / "a.png", ImageU8(8, 8, 4)).ok());
  auto bytes = *read_file(folder / "a.png");
  const auto put = [&](std::size_t at, std::uint32_t value) {
    for (int i = 0; i < 4; ++i) bytes[at + i] = static_cast<std::byte>(value >> (24 - 8 * i));
  };
  const auto set_size = [&](std::uint32_t width, std::uint32_t height) {
    put(16, width);
    put(20, height);
    put(29, crc32_of(std::span(bytes).subspan(12, 17)));
  };
  set_size(30000, 8000);
  auto read = decode_image8(bytes, "forged.png");
  ASSERT_FALSE(read.ok());
  EXPECT_NE(read.error().message.find("as many as can come from"), std::string::npos)
      << read.error().message;
  bytes[29] ^= std::byte{1};
  EXPECT_NE(decode_image8(bytes, "sum.png").error().message.find("CRC"), std::string::npos);
  set_size(40000, 8);
  read = decode_image8(bytes, "wide.png");
  ASSERT_FALSE(read.ok());
  EXPECT_NE(read.error().message.find("32768"), std::string::npos) << read.error().message;
}

// The largest real ratio: a picture of one colour, as strongly packed as deflate can.
TEST(ImageFile, AWidePictureOfOneColourIsNoForgery) {
  const test::ScratchFolder folder;
  ASSERT_TRUE(write_png8(folder / "a.png", ImageU8(16384, 64, 4, 77)).ok());
  const auto read = read_image8(folder / "a.png");
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(read->at(16383, 63, 2), 77);
}

TEST(ImageFile, OtherFilesAreNamedAsNoPicture) {
  const std::vector<unsigned char> text(100, 'a');
  const auto read = decode_image8(bytes_of(text), "notes.txt");
  ASSERT_FALSE(read.ok());
  EXPECT_EQ(read.error().code, ErrorCode::kBadInput);
  EXPECT_NE(read.error().message.find("bytes of another kind; accepted: a PNG, JPEG or WebP"),
            std::string::npos);
  EXPECT_FALSE(decode_image8({}, "empty").ok());
}

// A table of 288 codes where 256 is the most: other decoders write past their end here.
TEST(ImageFile, JpegTablesWithTooManyCodesAreRefused) {
  std::vector<unsigned char> jpeg = {0xff, 0xd8, 0xff, 0xc4, 0x01, 0x33, 0x00};
  jpeg.insert(jpeg.end(), 2, 0x90);  // 144 codes of 1 bit, 144 of 2
  jpeg.insert(jpeg.end(), 14 + 288, 0x00);
  const auto read = decode_image8(bytes_of(jpeg), "a.jpg");
  ASSERT_FALSE(read.ok());
  EXPECT_NE(read.error().message.find("Huffman"), std::string::npos) << read.error().message;
}

TEST(ImageFile, JpegsReadInEveryLayoutAndCutOnesAreErrors) {
  const auto folder = test::source_dir() / "tests/fuzz/corpus/images";
  const auto color = read_image8(folder / "rgb.jpg");
  ASSERT_TRUE(color.ok()) << color.error().message;
  EXPECT_EQ(color->channels, 3u);
  EXPECT_EQ(color->width, 16u);
  const auto rgba = read_image8(folder / "rgb.jpg", 4);
  ASSERT_TRUE(rgba.ok());
  for (std::size_t i = 0; i < 256; ++i) {
    EXPECT_EQ(rgba->data[4 * i + 1], color->data[3 * i + 1]);
    EXPECT_EQ(rgba->data[4 * i + 3], 255);
  }
  const auto gray = read_image8(folder / "gray.jpg");
  ASSERT_TRUE(gray.ok()) << gray.error().message;
  EXPECT_EQ(gray->channels, 1u);
  EXPECT_EQ(read_image8(folder / "gray.jpg", 4)->at(3, 3, 2), gray->at(3, 3));
  const auto bytes = *read_file(folder / "rgb.jpg");
  for (std::size_t length = 2; length + 8 < bytes.size(); length += 7)
    EXPECT_FALSE(decode_image8(std::span(bytes).first(length), "cut.jpg").ok()) << length;
}

// Channels of every type, a window that starts elsewhere, names in need of order.
TEST(ImageFile, OpenExrChannelsComeInOrderAndAsFloats) {
  const test::ScratchFolder folder;
  const auto path = folder / "a.exr";
  const int width = 5, height = 3;
  const Imath::Box2i window({-7, 100}, {-7 + width - 1, 100 + height - 1});
  std::vector<float> b(width * height), r(width * height);
  std::vector<half> g(width * height);
  std::vector<std::uint32_t> id(width * height);
  for (int i = 0; i < width * height; ++i) {
    r[i] = i + 0.25f, g[i] = half(i * 0.5f), b[i] = -i, id[i] = 1000u + i;
  }
  {
    Imf::Header header(window, window);
    header.channels().insert("layer.B", Imf::Channel(Imf::FLOAT));
    header.channels().insert("layer.G", Imf::Channel(Imf::HALF));
    header.channels().insert("layer.R", Imf::Channel(Imf::FLOAT));
    header.channels().insert("id", Imf::Channel(Imf::UINT));
    Imf::OutputFile file(path.c_str(), header);
    Imf::FrameBuffer frame;
    const auto insert = [&](const char* name, Imf::PixelType type, auto& list) {
      const std::size_t size = sizeof(list[0]);
      frame.insert(name, Imf::Slice::Make(type, list.data(), window, size, size * width));
    };
    insert("layer.R", Imf::FLOAT, r);
    insert("layer.G", Imf::HALF, g);
    insert("layer.B", Imf::FLOAT, b);
    insert("id", Imf::UINT, id);
    file.setFrameBuffer(frame);
    file.writePixels(height);
  }
  const auto exr = read_exr(path);
  ASSERT_TRUE(exr.ok()) << exr.error().message;
  EXPECT_EQ(exr->names, (std::vector<std::string>{"layer.R", "layer.G", "layer.B", "id"}));
  ASSERT_EQ(exr->image.width, 5u);
  ASSERT_EQ(exr->image.height, 3u);
  for (std::uint32_t y = 0; y < 3; ++y)
    for (std::uint32_t x = 0; x < 5; ++x) {
      const int i = static_cast<int>(y * 5 + x);
      EXPECT_EQ(exr->image.at(x, y, 0), i + 0.25f);
      EXPECT_EQ(exr->image.at(x, y, 1), i * 0.5f);
      EXPECT_EQ(exr->image.at(x, y, 2), static_cast<float>(-i));
      EXPECT_EQ(exr->image.at(x, y, 3), 1000.0f + i);
    }
  auto bytes = *read_file(path);
  for (std::size_t length = 0; length < bytes.size(); length += 3) {
    const auto cut = decode_exr(std::span(bytes).first(length), "cut.exr");
    if (cut.ok()) continue;
    EXPECT_EQ(cut.error().message.rfind("cut.exr: ", 0), 0u) << cut.error().message;
  }
  EXPECT_FALSE(decode_exr(std::span(bytes).first(bytes.size() / 2), "cut.exr").ok());
}

// One channel, 1, 2, 3, ... by rows of its data window.
std::filesystem::path write_counting_exr(const test::ScratchFolder& folder,
                                         const Imath::Box2i& display, const Imath::Box2i& window) {
  const auto path = folder / "crop.exr";
  const std::size_t width = window.max.x - window.min.x + 1,
                    height = window.max.y - window.min.y + 1;
  std::vector<float> values(width * height);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i + 1);
  Imf::Header header(display, window);
  header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
  Imf::OutputFile file(path.c_str(), header);
  Imf::FrameBuffer frame;
  frame.insert("Z", Imf::Slice::Make(Imf::FLOAT, values.data(), window, 4, 4 * width));
  file.setFrameBuffer(frame);
  file.writePixels(static_cast<int>(height));
  return path;
}

// A crop keeps its place in the picture, overscan goes.
TEST(ImageFile, AnOpenExrIsAsLargeAsItsDisplayWindow) {
  const test::ScratchFolder folder;
  const auto crop = read_exr(write_counting_exr(folder, {{-2, 10}, {5, 13}}, {{1, 11}, {2, 12}}));
  ASSERT_TRUE(crop.ok()) << crop.error().message;
  EXPECT_EQ(crop->image.data, (std::vector<float>{0, 0, 0, 0, 0, 0, 0, 0,  //
                                                  0, 0, 0, 1, 2, 0, 0, 0,  //
                                                  0, 0, 0, 3, 4, 0, 0, 0,  //
                                                  0, 0, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(crop->image.width, 8u);
  const auto over = read_exr(write_counting_exr(folder, {{0, 0}, {2, 1}}, {{-1, -1}, {1, 2}}));
  ASSERT_TRUE(over.ok()) << over.error().message;
  EXPECT_EQ(over->image.data, (std::vector<float>{5, 6, 0, 8, 9, 0}));
  EXPECT_FALSE(read_exr(write_counting_exr(folder, {{0, 0}, {2, 1}}, {{5, 5}, {6, 6}})).ok());
  // One pixel is left of an empty picture; a forged display window asks for no memory.
  EXPECT_TRUE(read_exr(write_counting_exr(folder, {{0, 0}, {3999, 1999}}, {{7, 7}, {7, 7}})).ok());
  EXPECT_FALSE(
      read_exr(write_counting_exr(folder, {{0, 0}, {32767, 32767}}, {{7, 7}, {7, 7}})).ok());
}

// The chunk with its length and checksum.
void append_chunk(std::vector<unsigned char>& out, const std::string& name,
                  const std::vector<unsigned char>& data) {
  std::vector<unsigned char> body(name.begin(), name.end());
  body.insert(body.end(), data.begin(), data.end());
  const auto put = [&out](std::size_t v) {
    for (int shift = 24; shift >= 0; shift -= 8)
      out.push_back(static_cast<unsigned char>(v >> shift));
  };
  put(data.size());
  out.insert(out.end(), body.begin(), body.end());
  put(crc32(0, body.data(), static_cast<uInt>(body.size())));
}

// rows: one byte of filter, then the packed pixels. palette: where the colour type is 3.
std::vector<unsigned char> png_of(unsigned char width, unsigned char height, unsigned char bits,
                                  unsigned char color_type, const std::vector<unsigned char>& rows,
                                  const std::vector<unsigned char>& palette = {}) {
  std::vector<unsigned char> out{0x89, 'P', 'N', 'G', 13, 10, 26, 10};
  append_chunk(out, "IHDR", {0, 0, 0, width, 0, 0, 0, height, bits, color_type, 0, 0, 0});
  if (!palette.empty()) append_chunk(out, "PLTE", palette);
  uLongf size = compressBound(rows.size());
  std::vector<unsigned char> packed(size);
  compress(packed.data(), &size, rows.data(), rows.size());
  packed.resize(size);
  append_chunk(out, "IDAT", packed);
  append_chunk(out, "IEND", {});
  return out;
}

// As masks of classes are exported: indices with colours to look at, and few bits.
TEST(ImageFile, NumbersOfAPngAreThoseStored) {
  const std::vector<unsigned char> colors{0, 0, 0, 128, 0, 0, 0, 128, 0, 128, 128, 0};
  const auto indices = png_of(2, 2, 8, 3, {0, 0, 1, 0, 2, 3}, colors);
  const auto packed = png_of(4, 1, 2, 3, {0, 0b00'01'10'11}, colors);
  for (const auto& bytes : {indices, packed}) {
    const auto read = decode_png_numbers(bytes_of(bytes), "a.png");
    ASSERT_TRUE(read.ok()) << read.error().message;
    EXPECT_TRUE(read->palette);
    EXPECT_EQ(read->image.channels, 1u);
    EXPECT_EQ(read->image.data, (std::vector<std::uint8_t>{0, 1, 2, 3}));
  }
  const auto bit = decode_png_numbers(bytes_of(png_of(8, 1, 1, 0, {0, 0b01100101})), "a.png");
  ASSERT_TRUE(bit.ok()) << bit.error().message;
  EXPECT_FALSE(bit->palette);
  EXPECT_EQ(bit->image.data, (std::vector<std::uint8_t>{0, 1, 1, 0, 0, 1, 0, 1}));
  const auto four = decode_png_numbers(bytes_of(png_of(3, 1, 4, 0, {0, 0x3f, 0x70})), "a.png");
  EXPECT_EQ(four->image.data, (std::vector<std::uint8_t>{3, 15, 7}));
  // As a picture the same are colours.
  EXPECT_EQ(decode_image8(bytes_of(indices), "a.png")->at(1, 0, 0), 128);
  EXPECT_EQ(decode_image8(bytes_of(png_of(3, 1, 4, 0, {0, 0x3f, 0x70})), "a.png")->at(0, 0), 51);
}

TEST(ImageFile, RealDepthAndNormalMapsReadAsTheirChannels) {
  NERITIC_REQUIRE_SHARED(shared);
  const auto wreck = shared / "data/rgbd/depth-synthetic-wreck";
  const auto depth = read_exr(wreck / "frame_0000_depth_m.exr");
  ASSERT_TRUE(depth.ok()) << depth.error().message;
  EXPECT_EQ(depth->image.width, 640u);
  EXPECT_EQ(depth->image.height, 480u);
  EXPECT_EQ(depth->names.size(), 1u);
  const auto normals = read_exr(wreck / "frame_0000_normal_cam.exr");
  ASSERT_TRUE(normals.ok()) << normals.error().message;
  ASSERT_EQ(normals->names.size(), 3u);
  std::size_t n_unit = 0, n_set = 0;
  for (std::size_t i = 0; i < normals->image.data.size(); i += 3) {
    const float* n = &normals->image.data[i];
    const double length = std::sqrt(double{n[0]} * n[0] + n[1] * n[1] + n[2] * n[2]);
    n_set += length > 0.0;
    n_unit += std::abs(length - 1.0) < 0.01;
  }
  EXPECT_GT(n_set, 1000u);
  EXPECT_EQ(n_unit, n_set);
}

TEST(ImageFile, EveryRealPictureReads) {
  NERITIC_REQUIRE_SHARED(shared);
  std::size_t n = 0, n_16 = 0, n_exr = 0;
  for (const char* part : {"data/rgbd", "data/photos"})
    for (const auto& entry : std::filesystem::recursive_directory_iterator(shared / part)) {
      const std::string extension = entry.path().extension();
      if (extension == ".exr") {
        const auto exr = read_exr(entry.path());
        ASSERT_TRUE(exr.ok()) << exr.error().message;
        EXPECT_FALSE(exr->image.empty());
        ++n_exr;
      } else if (extension == ".png" || extension == ".jpg") {
        if (is_png16(entry.path())) {
          const auto image = read_image16(entry.path());
          ASSERT_TRUE(image.ok()) << image.error().message;
          ++n_16;
        }
        const auto image = read_image8(entry.path());
        ASSERT_TRUE(image.ok()) << image.error().message;
        ++n;
      }
    }
  EXPECT_GT(n, 20u);
  EXPECT_GT(n_16, 2u);
  EXPECT_GT(n_exr, 5u);
}

}  // namespace
}  // namespace neritic::scene
