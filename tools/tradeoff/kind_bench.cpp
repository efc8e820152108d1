#include "tools/tradeoff/kind_bench.hpp"

#include <algorithm>
#include <cmath>

namespace neritic::tools {
using namespace testbed;
namespace {

// Renders beyond those asked for, while every one took no time by the device's clock (lavapipe's
// reads 0 where the machine's clock stood still).
constexpr int kMoreTries = 50;

KindBench::Measured times_of(const FrameResult& frame) {
  KindBench::Measured out;
  for (const gpu::PassTime& pass : frame.passes) {
    const auto has = [&](const char* word) { return pass.name.find(word) != std::string::npos; };
    if (pass.name == "record" || has("deform")) continue;
    if (has("sonar clear") || has("sonar gather"))
      out.gather_ms += pass.ms;
    else if (has("sonar resolve") || has("sonar pulse") || has("sonar beams") ||
             has("sonar receive"))
      out.receive_ms += pass.ms;
    else
      out.raster_ms += pass.ms;
  }
  return out;
}

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

Status KindBench::open(gpu::Device& device, const scene::Scene& scene) {
  scene::Scene own = scene;
  scene::Sonar first = with_knobs(kind_.base, kind_.middle);
  first.terms.level = scene::SonarLevel{};  // so that the session knows what objects scatter
  own.sonars = {first, first};              // prices are relative to the second
  own.cameras.clear();
  NERITIC_TRY(session_, Session::create(device, std::move(own)));
  session_->frames().enable_timing(true);
  return {};
}

void KindBench::place(std::size_t index, scene::Sonar sonar, const Shot& shot) {
  sonar.mount = moving_mount(shot.world_from_sonar);
  session_->replace_sonar(index, std::move(sonar));
}

Result<KindBench::Measured> KindBench::render(const scene::Sonar& sonar, int repeats,
                                              std::uint64_t draw) {
  Measured out;
  placed_.clear();
  const double share = 1.0 / static_cast<double>(kind_.shots.size());
  for (const Shot& shot : kind_.shots) {
    place(0, sonar, shot);
    FrameRequest request;
    request.sonars = {0};
    request.seed = session_->scene().seed + draw;
    request.frame = shot.frame;
    request.capture = request.capture.without_geometry();
    Measured least;
    const auto measured = [&] { return least.ms() > 0.0; };
    for (int i = 0; i < repeats + 1 || (repeats > 0 && !measured() && i < kMoreTries); ++i) {
      NERITIC_TRY(const FrameResult frame, session_->render(request));
      if (i == 0) {  // the first also compiles
        for (std::size_t head = 0; head < frame.sonars.size(); ++head) {
          const auto& intensity = frame.sonars[head].image.intensity;
          out.image.insert(out.image.end(), intensity.begin(), intensity.end());
          placed_.push_back({frame.sonars[head].world_from_head, head});
        }
        continue;
      }
      const Measured now = times_of(frame);
      if (!measured() || (now.ms() > 0.0 && now.ms() < least.ms())) least = now;
    }
    out.raster_ms += least.raster_ms * share;
    out.gather_ms += least.gather_ms * share;
    out.receive_ms += least.receive_ms * share;
  }
  return out;
}

Result<KindBench::Price> KindBench::price(const scene::Sonar& with, const scene::Sonar& without,
                                          int pairs) {
  Price out;
  double variance = 0.0;
  for (const Shot& shot : kind_.shots) {
    place(0, with, shot);
    place(1, without, shot);
    FrameRequest request;
    request.frame = shot.frame;
    request.capture = request.capture.without_geometry();
    std::vector<double> more_ms;
    for (int i = -1; i < pairs; ++i) {  // the first also compile
      double ms[2];
      for (const std::size_t k : {std::size_t(i & 1), std::size_t(~i & 1)}) {
        request.sonars = {k};
        NERITIC_TRY(const FrameResult frame, session_->render(request));
        ms[k] = times_of(frame).ms();
      }
      if (i >= 0) more_ms.push_back(ms[0] - ms[1]);
    }
    const double middle_ms = median_of(more_ms), n = static_cast<double>(more_ms.size());
    for (double& ms : more_ms) ms = std::abs(ms - middle_ms);
    // Standard error of a median of n normal values; their deviation is 1.48 times the median of
    // their distances from it.
    const double error_ms = 1.2533 * 1.4826 * median_of(more_ms) / std::sqrt(n);
    out.ms += middle_ms / static_cast<double>(kind_.shots.size());
    variance += error_ms * error_ms;
  }
  out.resolution_ms = std::sqrt(variance) / static_cast<double>(kind_.shots.size());
  return out;
}

}  // namespace neritic::tools
