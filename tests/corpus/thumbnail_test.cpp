// Models of the glTF asset generator beside the thumbnails that come with them, which another
// renderer made: seen from the same side, a plane shows the same pattern in the same colours. A
// sheet of both is left in build/.../corpus/ to be looked at.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "engine/core/files.hpp"
#include "engine/scene/gltf_loader.hpp"
#include "engine/scene/image_file.hpp"
#include "testbed/output/pictures.hpp"
#include "testbed/sensors/session.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/support/support.hpp"

namespace neritic::tools {
using namespace testbed;
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kThumbnail_px = 72;
// The generator's planes are 1 m wide and fill 64 of the 72 pixels; what is compared is well
// inside.
constexpr double kPlane_px = 64.0, kDistance_m = 3.0;
constexpr std::uint32_t kMargin_px = 9;

std::vector<fs::path> inside(const fs::path& folder) {
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(folder)) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  return paths;
}

// For these a plane shows too little, or something other than the thumbnail.
bool is_judged(const std::string& name) {
  static const std::set<std::string> others{
      // Points and lines, a pixel wide.
      "Mesh_PrimitiveMode_00", "Mesh_PrimitiveMode_01", "Mesh_PrimitiveMode_02",
      "Mesh_PrimitiveMode_03", "Mesh_PrimitiveMode_07", "Mesh_PrimitiveMode_08",
      "Mesh_PrimitiveMode_09", "Mesh_PrimitiveMode_10",
      // Holes, through which the thumbnail's room is seen; the third is nothing else.
      "Material_AlphaMask_02", "Material_AlphaMask_03", "Material_AlphaMask_06",
      // Metals, which mirror that room.
      "Material_MetallicRoughness_03", "Material_MetallicRoughness_06",
      "Material_MetallicRoughness_07", "Material_MetallicRoughness_08",
      "Material_MetallicRoughness_10", "Material_MetallicRoughness_11"};
  // Moving models are no planes, and the thumbnail's viewpoint matters.
  return !name.starts_with("Animation_") && !others.contains(name);
}

// Steep bumps, which a sun models harder than a room does.
bool is_relief(const std::string& name) {
  return name == "Material_04" || name == "Material_07";
}

struct Likeness {
  double pattern = 0.0;     // correlation of the three channels about their means
  double contrast = 0.0;    // standard deviation of the thumbnail, grey levels
  double colour = 0.0;      // largest difference of the mean colours' shares of red, green and blue
  double brightness = 0.0;  // of ours over the thumbnail's
  bool vivid = false;       // a channel of the thumbnail has less than a tenth of its light
};

Likeness compare(const ImageU8& ours, const ImageU8& theirs) {
  std::array<double, 3> mean_a{}, mean_b{};
  double n = 0.0;
  const auto each_pixel = [&](auto&& visit) {
    for (std::uint32_t y = kMargin_px; y < kThumbnail_px - kMargin_px; ++y)
      for (std::uint32_t x = kMargin_px; x < kThumbnail_px - kMargin_px; ++x)
        for (std::uint32_t c = 0; c < 3; ++c) visit(c, ours.at(x, y, c), theirs.at(x, y, c));
  };
  each_pixel([&](std::uint32_t c, double a, double b) {
    mean_a[c] += a;
    mean_b[c] += b;
    n += 1.0 / 3.0;
  });
  for (int c = 0; c < 3; ++c) mean_a[c] /= n, mean_b[c] /= n;
  double ab = 0.0, aa = 0.0, bb = 0.0;
  each_pixel([&](std::uint32_t c, double a, double b) {
    a -= mean_a[c];
    b -= mean_b[c];
    ab += a * b;
    aa += a * a;
    bb += b * b;
  });
  const double sum_a = mean_a[0] + mean_a[1] + mean_a[2] + 1e-9,
               sum_b = mean_b[0] + mean_b[1] + mean_b[2] + 1e-9;
  Likeness out;
  out.pattern = ab / std::sqrt(aa * bb + 1e-9);
  out.contrast = std::sqrt(bb / (3.0 * n));
  for (int c = 0; c < 3; ++c)
    out.colour = std::max(out.colour, std::abs(mean_a[c] / sum_a - mean_b[c] / sum_b));
  out.brightness = sum_a / sum_b;
  out.vivid = std::min({mean_b[0], mean_b[1], mean_b[2]}) < 0.1 * sum_b;
  return out;
}

bool alike(const Likeness& like, double least_pattern) {
  constexpr double kPlain = 10.0;  // less contrast is what shine does to an even surface
  // Colours near the edge of sRGB lose chroma on purpose (DECISIONS.md 41).
  const double most_colour = like.vivid ? 0.15 : 0.05, lost_pattern = like.vivid ? 0.05 : 0.0;
  return (like.contrast < kPlain || like.pattern > least_pattern - lost_pattern) &&
         like.colour < most_colour && like.brightness > 0.6 && like.brightness < 1.4;
}

ImageU8 turned(const ImageU8& image, bool left_right) {
  ImageU8 out(image.width, image.height, image.channels);
  for (std::uint32_t y = 0; y < image.height; ++y)
    for (std::uint32_t x = 0; x < image.width; ++x)
      for (std::uint32_t c = 0; c < image.channels; ++c)
        out.at(x, y, c) =
            left_right ? image.at(image.width - 1 - x, y, c) : image.at(x, image.height - 1 - y, c);
  return out;
}

class Thumbnails : public test::GpuTest {
 protected:
  // From straight ahead, as the generator's thumbnails are.
  Result<ViewImages> front_view(scene::Model model) {
    scene::Scene scene = scene::scene_of_model(std::move(model), kThumbnail_px, kThumbnail_px);
    scene::Camera& camera = scene.cameras[0];
    camera.mount.pose = {Vec3(0.0, 0.0, kDistance_m), Quat(1.0, 0.0, 0.0, 0.0)};
    camera.vertical_fov_rad = 2.0 * std::atan(0.5 * kThumbnail_px / kPlane_px / kDistance_m);
    camera.near_m = 0.01;
    NERITIC_TRY(const auto session, Session::create(device(), std::move(scene)));
    FrameRequest request;
    request.cameras = {0};
    NERITIC_TRY(FrameResult result, session->render(request));
    return std::move(result.cameras[0].eyes[0]);
  }
};

TEST_F(Thumbnails, PlanesShowTheSamePatternInTheSameColours) {
  NERITIC_REQUIRE_SHARED(shared);
  std::vector<Tile> tiles;
  int judged = 0, patterned = 0;
  for (const fs::path& folder : inside(shared / "data/gltf/gltf-asset-generator")) {
    if (!fs::is_directory(folder / "Figures/Thumbnails")) continue;
    for (const fs::path& picture : inside(folder / "Figures/Thumbnails")) {
      const std::string name = picture.stem().string();
      const fs::path path = folder / (name + ".gltf");
      if (!fs::exists(path)) continue;
      NERITIC_ASSERT_OK(const ImageU8 theirs, scene::read_image8(picture, 3));
      NERITIC_ASSERT_OK(scene::Model model, scene::load_gltf(path));
      NERITIC_ASSERT_OK(const ViewImages ours, front_view(std::move(model)));
      const Likeness like = compare(ours.color, theirs);
      tiles.push_back({ours.color, name.substr(name.find('_') + 1, 11)});
      tiles.push_back({theirs, "theirs"});
      if (!is_judged(name)) continue;
      ++judged;
      // A sun and even light model bumps of metal another way than a room does: 0.848.
      const double least_pattern = is_relief(name) ? 0.65 : 0.84;
      EXPECT_TRUE(alike(like, least_pattern))
          << fmt::format("{}: pattern {:.2f}, colour {:.3f}, brightness {:.2f}", name, like.pattern,
                         like.colour, like.brightness);
      // The wrong way round it would not pass.
      if (like.contrast < 10.0) continue;
      ++patterned;
      for (const bool left_right : {false, true}) {
        if (left_right && is_relief(name)) continue;
        EXPECT_FALSE(alike(compare(turned(ours.color, left_right), theirs), least_pattern))
            << name << left_right;
      }
    }
  }
  EXPECT_EQ(tiles.size(), 2u * 72);
  EXPECT_EQ(judged, 39);
  EXPECT_GE(patterned, 20);
  const fs::path out = fs::path(NERITIC_BINARY_DIR) / "corpus";
  NERITIC_ASSERT_STATUS(make_folder(out));
  NERITIC_ASSERT_STATUS(scene::write_png8(out / "thumbnails.png",
                                          grid_sheet(tiles, 16, kThumbnail_px, kThumbnail_px)));
}

}  // namespace
}  // namespace neritic::tools
