#include "sonar/coco_pictures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "engine/core/files.hpp"
#include "engine/scene/image_file.hpp"
#include "sonar/write_sonar.hpp"

namespace neritic::sonar {
namespace {

constexpr double kLevelCount_db = 0.3, kCosineCount_db = 0.15;

}  // namespace

CocoPictures::CocoPictures(std::filesystem::path folder, bool level,
                           const scene::SonarOutput& output)
    : folder_(std::move(folder)), level_(level), fixed_(level && output.named), shown_(output) {
  shown_.bits = 8;
  if (!fixed_) shown_.span_db = 255.0 * (level ? kLevelCount_db : kCosineCount_db);
}

Status CocoPictures::add(const std::string& name, const SonarImage& image) {
  float most = 0.0f;
  for (const float v : image.intensity)
    if (std::isfinite(v)) most = std::max(most, v);
  if (!fixed_ && most > 0.0f) {
    const double count_db = shown_.span_db / 255.0;
    const auto white = static_cast<std::int64_t>(std::ceil(10.0 * std::log10(most) / count_db));
    white_ = heard_ ? std::max(white_, white) : white;
    heard_ = true;
    shown_.floor_db = static_cast<double>(white_ - 255) * count_db;
  }
  ImageU8 out(image.n_azimuth, image.n_range, 1);
  const std::vector<std::uint16_t> counts = quantize(image.intensity, shown_);
  for (std::size_t i = 0; i < counts.size(); ++i)
    out.data[i] = static_cast<std::uint8_t>(counts[i]);
  // A silent picture is black on any scale.
  drawn_[name] = most > 0.0f ? white_ : std::numeric_limits<std::int64_t>::max();
  NERITIC_TRY_STATUS(make_folder((folder_ / name).parent_path()));
  return scene::write_png8(folder_ / name, out);
}

Status CocoPictures::finish() {
  for (auto& [name, white] : drawn_) {
    if (white >= white_) continue;
    NERITIC_TRY(ImageU8 picture, scene::read_image8(folder_ / name));
    const std::int64_t less = white_ - white;
    for (std::uint8_t& grey : picture.data)
      grey = static_cast<std::uint8_t>(std::max<std::int64_t>(0, grey - less));
    NERITIC_TRY_STATUS(scene::write_png8(folder_ / name, picture));
    white = white_;
  }
  return {};
}

nlohmann::json CocoPictures::scale() const {
  nlohmann::json out{{"units", level_ ? "dB re 1 uPa" : "10 log10 of the mean cosine"}};
  if (!fixed_ && !heard_) return out;  // all silent: black
  out["floor_db"] = shown_.floor_db;
  out["full_scale_db"] = shown_.floor_db + shown_.span_db;
  return out;
}

}  // namespace neritic::sonar
