// Reads the tables of a camera: lens, sensor, white balance (camera_terms.hpp).
#include "engine/scene/scene_draft.hpp"
#include "engine/scene/scene_reader.hpp"

namespace neritic::scene {
namespace {

constexpr Interval kCoefficient{-100, 100};

Lens read_lens(TableReader& reader) {
  Lens lens;
  const std::string model =
      reader.choice("model", "", std::to_array<Key>({"brown_conrady", "fisheye"}));
  if (model.empty()) reader.refuse_table("no model", "model, brown_conrady or fisheye");
  const bool fisheye = model == "fisheye";
  lens.model = fisheye ? LensModel::kFisheye : LensModel::kBrownConrady;
  const std::vector<double> k = fisheye ? reader.numbers("k", {1, 2, 3, 4}, kCoefficient)
                                        : reader.numbers("k", {1, 2, 3}, kCoefficient);
  std::copy(k.begin(), k.end(), lens.k.begin());
  const std::vector<double> p = reader.numbers("p", {2}, kCoefficient);
  if (p.size() == 2) lens.p = {p[0], p[1]};
  if (fisheye && reader.has("p")) reader.refuse("p", "no such key of a fisheye");
  return lens;
}

ImageSensor read_image_sensor(TableReader& reader) {
  ImageSensor sensor;
  sensor.gain_db = reader.number("gain_db", sensor.gain_db, {0, 60, false, false, "decibels"});
  sensor.full_well_e =
      reader.number("full_well_e", sensor.full_well_e, {10, 1e7, false, false, "electrons"});
  sensor.read_noise_e =
      reader.number("read_noise_e", sensor.read_noise_e, {0, 1e4, false, false, "electrons"});
  sensor.saturation_ev =
      reader.number("saturation_ev", sensor.saturation_ev, {-4, 12, false, false, "stops"});
  sensor.bits = static_cast<std::uint32_t>(reader.whole("bits", sensor.bits, 6, 16));
  constexpr auto kNames = std::to_array<Key>({"none", "rggb", "bggr", "grbg", "gbrg"});
  const std::string bayer = reader.choice("bayer", "none", kNames);
  sensor.bayer =
      static_cast<Bayer>(std::find(kNames.begin(), kNames.end(), bayer) - kNames.begin());
  return sensor;
}

WhiteBalance read_white_balance(TableReader& reader) {
  const TomlValue* value = reader.find("white_balance");
  if (value->kind == TomlValue::Kind::kString) {
    if (value->text != "auto")
      reader.refuse("white_balance", "\"auto\" or gains [red, green, blue] in [0.1, 20]");
    return {true, Vec3(1.0)};
  }
  return {false, reader.vector3("white_balance", Vec3(1.0), {0.1, 20})};
}

}  // namespace

void read_camera_terms(TableReader& reader, Camera& camera) {
  CameraTerms& terms = camera.terms;
  terms.lens = read_term<Lens>(reader, "lens", kLensKeys, read_lens);
  terms.sensor = read_term<ImageSensor>(reader, "sensor", kImageSensorKeys, read_image_sensor);
  if (reader.has("white_balance")) terms.white_balance = read_white_balance(reader);
  terms.vignette = reader.number("vignette", 0.0, {0, 4});
  terms.linear = reader.flag("linear", false);
  if (!reader.ok() || !terms.lens) return;
  if (const auto view =
          lens_view(*terms.lens, camera.width, camera.height, camera.vertical_fov_rad);
      !view.ok())
    reader.fail({view.error().code, reader.place("lens") + view.error().message.substr(4)});
}

}  // namespace neritic::scene
