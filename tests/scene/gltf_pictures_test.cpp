// Pictures of small files cannot take all memory: the same bytes are decoded and held once, and
// sizes are counted before anything is decoded.
#include <algorithm>

#include "engine/core/files.hpp"
#include "engine/scene/image_file.hpp"
#include "tests/scene/gltf_builder.hpp"
#include "tests/support/support.hpp"

namespace neritic::scene {
namespace {

using Builder = GltfBuilder;

// A material, a texture and a picture each, n times; source(i) is picture i's JSON.
template <class Source>
Builder with_pictures(int n, const Source& source) {
  Builder b;
  b.quad();
  for (int i = 0; i < n; ++i) {
    b.json["images"].push_back(source(b, i));
    b.json["textures"].push_back({{"source", i}});
    b.json["materials"].push_back({{"emissiveTexture", {{"index", i}}}});
  }
  return b;
}

std::vector<std::uint8_t> plain_png(std::uint32_t side) {
  const test::ScratchFolder folder;
  EXPECT_TRUE(write_png8(folder / "plain.png", ImageU8(side, side, 3, 40)).ok());
  const auto file = read_file(folder / "plain.png");
  EXPECT_TRUE(file.ok());
  const auto* first = reinterpret_cast<const std::uint8_t*>(file->data());
  return {first, first + file->size()};
}

std::size_t bytes_held(const Model& model) {
  std::size_t sum = 0;
  for (const ImageU8& image : model.images) sum += image.data.size();
  return sum;
}

TEST(GltfPictures, TwoHundredMaterialsOfOneBigPictureHoldItOnce) {
  constexpr std::uint32_t kSide_px = 1024;
  const auto png = plain_png(kSide_px);
  int view = -1;
  Builder b = with_pictures(200, [&](Builder& made, int) {
    if (view < 0) view = made.view(png);
    return Json{{"bufferView", view}, {"mimeType", "image/png"}};
  });
  const auto model = b.load();
  ASSERT_LOADS(model);
  EXPECT_TRUE(model->notes.empty()) << model->notes[0];
  EXPECT_EQ(bytes_held(*model), kSide_px * kSide_px * 4u + 199u * 4u);
  for (const Material& material : model->materials) {
    const int image = model->textures[material.emissive_texture.texture].image;
    EXPECT_EQ(model->images[image].width, kSide_px);
  }
}

TEST(GltfPictures, OneFileNamedTwiceIsHeldOnce) {
  const test::ScratchFolder folder;
  ASSERT_TRUE(write_png8(folder / "a.png", ImageU8(64, 32, 3, 9)).ok());
  ASSERT_TRUE(write_png8(folder / "b.png", ImageU8(16, 16, 3, 9)).ok());
  Builder b = with_pictures(4, [&](Builder&, int i) {
    return Json{{"uri", i % 2 == 0 ? "a.png" : "b.png"}};
  });
  const auto model = b.load(folder.path());
  ASSERT_LOADS(model);
  EXPECT_EQ(bytes_held(*model), 64u * 32u * 4u + 16u * 16u * 4u + 2u * 4u);
  EXPECT_EQ(model->textures[2].image, 0);
  EXPECT_EQ(model->textures[3].image, 1);
}

// Each claims 16384 x 16384 pixels, 1 GiB decoded: the limit of small files. The first is let
// through (and then found broken), the others are not even looked at.
TEST(GltfPictures, SizesAreCountedBeforeAnythingIsDecoded) {
  std::vector<std::uint8_t> png = plain_png(16);
  png[18] = png[22] = 0x40;  // big-endian 16384 in the third byte of width and height
  png[19] = png[23] = 0;
  Builder b = with_pictures(3, [&](Builder& made, int) {
    return Json{{"bufferView", made.view(png)}, {"mimeType", "image/png"}};
  });
  const auto model = b.load();
  ASSERT_LOADS(model);
  ASSERT_EQ(model->notes.size(), 3u);
  EXPECT_EQ(model->notes[0].find("too much for a file of this size"), std::string::npos);
  for (int i = 1; i < 3; ++i)
    EXPECT_NE(model->notes[i].find(fmt::format("images[{}]: 16384 x 16384 pixels, with the file's "
                                               "other pictures too much",
                                               i)),
              std::string::npos)
        << model->notes[i];
}

TEST(GltfPictures, SizesInHeadersAreThoseOfTheDecodedPictures) {
  const auto png = plain_png(37);
  const PictureSize size = peek_size(std::as_bytes(std::span(png)));
  EXPECT_EQ(size.width, 37u);
  EXPECT_EQ(size.height, 37u);
  const auto jpeg = read_file(test::source_dir() / "assets/textures/sand_color.jpg");
  ASSERT_TRUE(jpeg.ok());
  const auto decoded = decode_image8(*jpeg, "sand", 4);
  ASSERT_TRUE(decoded.ok());
  EXPECT_EQ(peek_size(*jpeg).width, decoded->width);
  EXPECT_EQ(peek_size(*jpeg).height, decoded->height);
  EXPECT_EQ(peek_size(std::span(*jpeg).first(20)).width, 0u);
  EXPECT_EQ(peek_size({}).width, 0u);
}

}  // namespace
}  // namespace neritic::scene
