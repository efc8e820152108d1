#include "testbed/view/picker.hpp"

#include <algorithm>
#include <cmath>

#include "engine/render/renderer.hpp"
#include "testbed/view/panel_frame.hpp"

namespace neritic::testbed {

std::string words_of_label(const scene::Scene& scene, std::uint16_t class_id,
                           std::uint16_t instance) {
  if (class_id == 0 && instance == 0) return {};
  std::string name;
  for (const scene::Object& object : scene.objects)
    if (instance >= object.instance &&
        std::size_t{instance} < object.instance + object.instance_count())
      name = object.name;
  const auto found = scene.class_names.find(class_id);
  const std::string kind = found == scene.class_names.end() ? "" : found->second;
  if (name.empty()) return kind;
  return kind.empty() || kind == name ? name : name + ", " + kind;
}

void Picker::ask(const Vec2& at, const FrustumTangents& tangents, const FrustumTangents& shown) {
  if (pick_ && pick_->declared) return;  // the last one is under way
  const Vec2 across(glm::mix(shown.left, shown.right, at.x),
                    glm::mix(shown.top, shown.bottom, at.y));
  pick_ = Pick{.at = at,
               .in_view = {(across.x - tangents.left) / (tangents.right - tangents.left),
                           (across.y - tangents.top) / (tangents.bottom - tangents.top)},
               .tangents = tangents};
}

Status Picker::declare(graph::FrameGraph& graph, const SensorFrame::Views& views) {
  if (!pick_ || pick_->declared || !views.label || !views.depth) return {};
  const auto pixel = [](double part, std::uint32_t size) {
    return static_cast<std::uint32_t>(std::clamp(part * size, 0.0, size - 1.0));
  };
  pick_->texel = std::size_t{pixel(pick_->in_view.y, views.height)} * views.width +
                 pixel(pick_->in_view.x, views.width);
  pick_->near_m = views.near_m;
  NERITIC_TRY(pick_->label, readback_.declare(graph, device_, "picked label", views.label,
                                              render::kLabelFormat, views.width, views.height, 1));
  NERITIC_TRY(pick_->depth, readback_.declare(graph, device_, "picked depth", views.depth,
                                              render::kDepthFormat, views.width, views.height, 1));
  pick_->declared = true;
  return {};
}

void Picker::submitted(std::uint64_t value) {
  if (pick_ && pick_->declared && pick_->done == 0) pick_->done = value;
}

std::string picked_words(const std::string& label, double distance_m, hud::Units units) {
  return fmt::format("{}, {}", label, length_text(distance_m, 2, units));
}

std::optional<Picked> Picker::take(std::uint64_t completed, const scene::Scene& scene,
                                   hud::Units units) {
  if (!pick_ || pick_->done == 0 || pick_->done > completed) return std::nullopt;
  const Pick pick = std::move(*pick_);
  pick_.reset();
  const std::uint32_t label = pick.label->mapped<std::uint32_t>()[pick.texel];
  const double depth = pick.depth->mapped<float>()[pick.texel];
  const std::string words = words_of_label(scene, static_cast<std::uint16_t>(label & 0xFFFF),
                                           static_cast<std::uint16_t>(label >> 16));
  if (words.empty() || !(depth > 0.0)) return Picked{pick.at, "open water"};
  const FrustumTangents& t = pick.tangents;
  const Vec3 ray(glm::mix(t.left, t.right, pick.in_view.x),
                 glm::mix(t.top, t.bottom, pick.in_view.y), -1.0);
  return Picked{pick.at, picked_words(words, pick.near_m / depth * glm::length(ray), units)};
}

}  // namespace neritic::testbed
