#include "tools/tradeoff/xr_tradeoff.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>

#include "engine/scene/scene.hpp"
#include "hud/hud.hpp"
#include "testbed/sensors/session.hpp"

namespace neritic::tools {
namespace {

constexpr double kEyes_m = 0.064;
// Half of a common headset's picture: asymmetric, as its eyes are.
constexpr FrustumTangents kLeftEye{-1.19, 0.84, -1.11, 0.97};
constexpr int kRepeats = 3;

FrustumTangents tangents_of_eye(int eye) {
  return eye == 0 ? kLeftEye
                  : FrustumTangents{-kLeftEye.right, -kLeftEye.left, kLeftEye.bottom, kLeftEye.top};
}

FrustumTangents focus_tangents(double half_deg) {
  const double t = std::tan(radians(half_deg));
  return {-t, t, -t, t};
}

struct XrSetting {
  std::string views;
  double scale = 1.0, focus_deg = 0.0;
};

std::vector<XrSetting> settings_of(const XrTradeoffOptions& options) {
  std::vector<XrSetting> out;
  const std::vector<double> scales = options.quick
                                         ? std::vector<double>{1.0, 0.5}
                                         : std::vector<double>{1.0, 0.85, 0.7, 0.5, 0.35, 0.25};
  for (const double scale : scales) out.push_back({"two", scale, 0.0});
  out.push_back({"one", 1.0, 0.0});
  const std::vector<double> angles =
      options.quick ? std::vector<double>{15.0} : std::vector<double>{8.0, 12.0, 16.0, 22.0};
  const std::vector<double> wide =
      options.quick ? std::vector<double>{0.35} : std::vector<double>{0.5, 0.35, 0.25};
  for (const double scale : wide)
    for (const double half_deg : angles) out.push_back({"four", scale, half_deg});
  return out;
}

struct EyePictures {
  std::vector<ImageU8> wide, focus;  // by eye
  double ms = 0.0, mpixels = 0.0;
};

testbed::ViewsRequest views_request(const std::string& name, const scene::Scene& scene,
                                    const Pose& head, std::uint32_t width, std::uint32_t height,
                                    int eyes, double focus_deg) {
  testbed::ViewsRequest out{.name = name,
                            .exposure = scene.cameras.front().exposure,
                            .capture = testbed::Capture{.motion = false}.without_geometry()};
  out.views.width = width, out.views.height = height;
  for (int eye = 0; eye < eyes; ++eye) {
    const Pose pose = head * Pose{{kEyes_m * (eye - 0.5), 0.0, 0.0}};
    out.views.views.push_back(
        {.world_from_view = pose,
         .tangents = focus_deg > 0.0 ? focus_tangents(focus_deg) : tangents_of_eye(eye),
         .next_world_from_view = pose});
  }
  return out;
}

// The least device time of some frames.
Result<EyePictures> draw_setting(testbed::Session& session, const Pose& head,
                                 const XrSetting& setting, std::uint32_t side_px, int repeats) {
  const auto pixels = [](double size) {
    return static_cast<std::uint32_t>(std::max(1.0, std::round(size)));
  };
  const std::uint32_t wide = pixels(setting.scale * side_px);
  const int eyes = setting.views == "one" ? 1 : 2;
  // As dense as the full picture.
  const FrustumTangents f = focus_tangents(setting.focus_deg);
  const std::uint32_t sharp =
      pixels(side_px * (f.right - f.left) / (kLeftEye.right - kLeftEye.left));
  EyePictures out;
  out.ms = 1e300;
  for (int i = 0; i < repeats; ++i) {
    testbed::FrameRequest request;
    request.views.push_back(views_request("wide", session.scene(), head, wide, wide, eyes, 0.0));
    if (setting.focus_deg > 0.0)
      request.views.push_back(
          views_request("focus", session.scene(), head, sharp, sharp, eyes, setting.focus_deg));
    NERITIC_TRY(testbed::FrameResult result, session.render(request));
    double ms = 0.0;
    for (const gpu::PassTime& pass : result.passes)
      if (pass.name != "record" && pass.name.find("readback") == std::string::npos) ms += pass.ms;
    out.ms = std::min(out.ms, ms);
    out.wide.clear(), out.focus.clear();
    for (testbed::ViewImages& eye : result.views[0].eyes) out.wide.push_back(std::move(eye.color));
    if (setting.focus_deg > 0.0)
      for (testbed::ViewImages& eye : result.views[1].eyes)
        out.focus.push_back(std::move(eye.color));
  }
  out.mpixels = 1e-6 * eyes *
                (static_cast<double>(wide) * wide +
                 (setting.focus_deg > 0.0 ? static_cast<double>(sharp) * sharp : 0.0));
  return out;
}

// Between the centres of four pixels.
double bilinear(const ImageU8& image, double x, double y, std::uint32_t channel) {
  const double u = std::clamp(x - 0.5, 0.0, image.width - 1.0);
  const double v = std::clamp(y - 0.5, 0.0, image.height - 1.0);
  const auto left = static_cast<std::uint32_t>(u), top = static_cast<std::uint32_t>(v);
  const std::uint32_t right = std::min(left + 1, image.width - 1),
                      below = std::min(top + 1, image.height - 1);
  const double a = u - left, b = v - top;
  return glm::mix(
      glm::mix(double(image.at(left, top, channel)), double(image.at(right, top, channel)), a),
      glm::mix(double(image.at(left, below, channel)), double(image.at(right, below, channel)), a),
      b);
}

// The picture of an eye at full resolution: the wide picture stretched, the sharp one over it.
ImageU8 seen_by(const EyePictures& drawn, int eye, double focus_deg, std::uint32_t side_px) {
  const FrustumTangents t = tangents_of_eye(eye), f = focus_tangents(focus_deg);
  const auto picture = [eye](const std::vector<ImageU8>& all) -> const ImageU8& {
    return all[std::min<std::size_t>(static_cast<std::size_t>(eye), all.size() - 1)];
  };
  const ImageU8& wide = picture(drawn.wide);
  ImageU8 out(side_px, side_px, 3);
  for (std::uint32_t y = 0; y < side_px; ++y)
    for (std::uint32_t x = 0; x < side_px; ++x) {
      const double across = (x + 0.5) / side_px, down = (y + 0.5) / side_px;
      const double tx = glm::mix(t.left, t.right, across), ty = glm::mix(t.top, t.bottom, down);
      const bool sharp = focus_deg > 0.0 && std::abs(tx) < f.right && std::abs(ty) < f.top;
      const ImageU8& from = sharp ? picture(drawn.focus) : wide;
      const double u = sharp ? (tx - f.left) / (f.right - f.left) : across;
      const double v = sharp ? (f.top - ty) / (f.top - f.bottom) : down;
      for (std::uint32_t c = 0; c < 3; ++c)
        out.at(x, y, c) = static_cast<std::uint8_t>(
            std::lround(bilinear(from, u * from.width, v * from.height, c)));
    }
  return out;
}

// A diver who rises by 18 m a minute, the fastest that alarms allow for; a clock of 240 Hz.
HudRatePoint hud_at(double rate_hz) {
  constexpr double kRise_m_s = 18.0 / 60.0, kTick_s = 1.0 / 240.0, kSeconds = 10.0;
  hud::Hud instrument(hud::LayoutKind::kWrist, hud::Units::kMetric,
                      hud::layout_of(hud::LayoutKind::kWrist).height_px);
  HudRatePoint out{.rate_hz = rate_hz};
  hud::DiveData data;
  data.bar_per_m = 0.10052;
  double next_s = 0.0, shown_m = 30.0, spent = 0.0;
  for (double time_s = 0.0; time_s < kSeconds; time_s += kTick_s) {
    const double depth_m = 30.0 - kRise_m_s * time_s;
    if (time_s >= next_s - 1e-9) {
      next_s += 1.0 / rate_hz;
      shown_m = depth_m;
      data.time_s = time_s;
      data.depth_m = depth_m;
      data.dive_min = time_s / 60.0;
      data.ascent_m_min = 60.0 * kRise_m_s;
      const std::clock_t begin = std::clock();
      instrument.update(data, data.time_s);
      spent += static_cast<double>(std::clock() - begin);
    }
    out.late_m = std::max(out.late_m, std::abs(shown_m - depth_m));
  }
  out.ms_a_second = 1e3 * spent / CLOCKS_PER_SEC / kSeconds;
  return out;
}

constexpr double kHudRates_hz[] = {1.0, 2.0, 5.0, 10.0, 30.0, 90.0};

}  // namespace

std::uint64_t steps(const XrTradeoffOptions& options) {
  return settings_of(options).size() + 1 + std::size(kHudRates_hz);
}

double acuity_weight(double eccentricity_deg) {
  const double acuity = 1.0 / (1.0 + eccentricity_deg / 2.3);
  return acuity * acuity;
}

double weighted_error(const ImageU8& shown, const ImageU8& wanted, const FrustumTangents& view,
                      bool weighted) {
  double sum = 0.0, weights = 0.0;
  for (std::uint32_t y = 0; y < wanted.height; ++y)
    for (std::uint32_t x = 0; x < wanted.width; ++x) {
      const double tx = glm::mix(view.left, view.right, (x + 0.5) / wanted.width);
      const double ty = glm::mix(view.top, view.bottom, (y + 0.5) / wanted.height);
      const double w = weighted ? acuity_weight(degrees(std::atan(std::hypot(tx, ty)))) : 1.0;
      for (std::uint32_t c = 0; c < 3; ++c) {
        const double off = double(shown.at(x, y, c)) - wanted.at(x, y, c);
        sum += w * off * off;
      }
      weights += 3.0 * w;
    }
  return std::sqrt(sum / weights);
}

Result<XrTradeoff> run_xr_tradeoff(const XrTradeoffOptions& options) {
  NERITIC_TRY(scene::Scene scene, scene::load_scene(options.scene));
  if (scene.cameras.empty())
    return failure(ErrorCode::kBadInput, "{}: found no camera; accepted: a scene with one",
                   options.scene);
  gpu::DeviceOptions device_options;
  device_options.device = options.device;
  NERITIC_TRY(const auto device, gpu::Device::create(device_options));
  NERITIC_TRY(const auto session, testbed::Session::create(*device, std::move(scene)));
  const Pose head = session->scene().world_from(session->scene().cameras.front().mount);
  XrTradeoff out{.device = device->info().name, .side_px = options.quick ? 160u : 800u};
  const int repeats = options.quick ? 2 : kRepeats;
  // The first frame of a session makes pipelines and uploads: it is the reference's.
  NERITIC_TRY(const EyePictures full,
              draw_setting(*session, head, {"two", 1.0, 0.0}, out.side_px, 1));
  options.step();
  for (const XrSetting& setting : settings_of(options)) {
    NERITIC_TRY(const EyePictures drawn,
                draw_setting(*session, head, setting, out.side_px, repeats));
    XrPoint point{.views = setting.views,
                  .scale = setting.scale,
                  .focus_deg = setting.focus_deg,
                  .mpixels = drawn.mpixels,
                  .ms = drawn.ms};
    for (int eye = 0; eye < 2; ++eye) {
      const ImageU8 seen = seen_by(drawn, eye, setting.focus_deg, out.side_px);
      const ImageU8& wanted = full.wide[static_cast<std::size_t>(eye)];
      const auto squared = [&](bool weighted) {
        const double error = weighted_error(seen, wanted, tangents_of_eye(eye), weighted);
        return 0.5 * error * error;
      };
      point.error += squared(false);
      point.fovea_error += squared(true);
    }
    point.error = std::sqrt(point.error);
    point.fovea_error = std::sqrt(point.fovea_error);
    out.points.push_back(point);
    options.step();
  }
  for (const double rate_hz : kHudRates_hz) {
    out.hud.push_back(hud_at(rate_hz));
    options.step();
  }
  return out;
}

}  // namespace neritic::tools
