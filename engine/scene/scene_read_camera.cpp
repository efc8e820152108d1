// Reads the tables of a camera: lens, sensor, white balance (camera_terms.hpp).
#include "engine/scene/number_rows.hpp"
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

Port read_port(TableReader& reader) {
  Port port;
  const std::string kind = reader.choice("kind", "", std::to_array<Key>({"flat", "dome"}));
  if (kind.empty()) reader.refuse_table("no kind", "kind, flat or dome");
  port.kind = kind == "dome" ? PortKind::kDome : PortKind::kFlat;
  port.offset = reader.number("offset", 0.0, {-0.5, 0.5});
  if (kind == "flat" && reader.has("offset")) reader.refuse("offset", "no such key of a flat port");
  return port;
}

Focus read_focus(TableReader& reader) {
  Focus focus;
  focus.distance_m =
      reader.number("distance_m", focus.distance_m, {0.05, 1e4, false, false, "metres"});
  focus.f_number = reader.number("f_number", focus.f_number, {0.5, 64});
  focus.focal_length_m = 1e-3 * reader.number("focal_length_mm", 1e3 * focus.focal_length_m,
                                              {1, 1000, false, false, "millimetres"});
  focus.samples = static_cast<std::uint32_t>(reader.whole("samples", focus.samples, 4, 256));
  return focus;
}

Shutter read_shutter(TableReader& reader) {
  Shutter shutter;
  shutter.exposure_s =
      reader.number("exposure_s", shutter.exposure_s, {0, 10, false, false, "seconds"});
  shutter.readout_s =
      reader.number("readout_s", shutter.readout_s, {0, 10, false, false, "seconds"});
  shutter.samples = static_cast<std::uint32_t>(reader.whole("samples", shutter.samples, 2, 128));
  return shutter;
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

// A file of rows [nm, red, green, blue].
Spectrum read_spectrum(TableReader& reader) {
  Spectrum out;
  out.bands = static_cast<std::uint32_t>(reader.whole("bands", out.bands, 9, 15));
  if (out.bands % 3 != 0) reader.refuse("bands", "9, 12 or 15");
  const TomlValue* value = reader.find("response");
  if (!value || (value->kind == TomlValue::Kind::kString && value->text == "eye")) return out;
  const std::filesystem::path path = reader.file("response");
  if (path.empty()) return out;
  const auto refused = [&](std::string_view found) {
    reader.refuse("response",
                  fmt::format("\"eye\", or a .csv file of rows nm, red, green, blue with rising "
                              "wavelengths from 400 or less to 700 or more and responses in [0, "
                              "1e6]: {}",
                              found));
  };
  const auto rows = read_rows(path, {4, 4, 1e6, 10000, "four numbers: nm, red, green, blue"});
  if (!rows.ok()) {
    reader.fail({rows.error().code, reader.place("response") + ": " + rows.error().message});
    return out;
  }
  Vec3 sum(0.0);
  for (const NumberRow& numbers : *rows) {
    const std::vector<double>& row = numbers.values;
    const bool rises = out.response.empty() || row[0] > out.response.back().wavelength_nm;
    const bool sound = std::ranges::all_of(row, [](double x) { return x >= 0.0; });
    if (!rises || !sound) {
      refused(fmt::format("line {} is none", numbers.line));
      return out;
    }
    out.response.push_back({row[0], {row[1], row[2], row[3]}});
    sum += out.response.back().channels;
  }
  if (out.response.empty() || out.response.front().wavelength_nm > 400.0 ||
      out.response.back().wavelength_nm < 700.0 || !(std::min({sum.x, sum.y, sum.z}) > 0.0))
    refused("it covers less, or a channel has none");
  return out;
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
  terms.spectrum = read_term<Spectrum>(reader, "spectrum", kSpectrumKeys, read_spectrum);
  terms.lens = read_term<Lens>(reader, "lens", kLensKeys, read_lens);
  const auto port = read_term<Port>(reader, "port", kPortKeys, read_port);
  if (port) {
    if (!terms.lens) terms.lens = Lens{};
    terms.lens->port = *port;
  }
  terms.focus = read_term<Focus>(reader, "focus", kFocusKeys, read_focus);
  terms.shutter = read_term<Shutter>(reader, "shutter", kShutterKeys, read_shutter);
  terms.sensor = read_term<ImageSensor>(reader, "sensor", kImageSensorKeys, read_image_sensor);
  if (reader.has("white_balance")) terms.white_balance = read_white_balance(reader);
  terms.vignette = reader.number("vignette", 0.0, {0, 4});
  terms.linear = reader.flag("linear", false);
  if (!reader.ok() || !terms.lens) return;
  if (const auto view =
          lens_view(*terms.lens, camera.width, camera.height, camera.vertical_fov_rad);
      !view.ok())
    reader.fail({view.error().code, reader.place(reader.has("lens") ? "lens" : "port") +
                                        view.error().message.substr(4)});
}

}  // namespace neritic::scene
