#include "testbed/view/console.hpp"

#include "testbed/view/help_panel.hpp"

namespace neritic::testbed {
namespace {

constexpr TimeNs kNote_ns = 5'000'000'000;  // how long a note stays on the screen

// "paused", "0.5 x speed"; empty at the host's pace.
std::string pace_words(sim::RunClock* clock) {
  if (!clock) return {};
  if (clock->paused()) return "paused";
  return clock->speed() == 1.0 ? std::string() : fmt::format("{:g} x speed", clock->speed());
}

// A panel that covers the group's first view, texel on pixel.
xr::PanelLayer screen_panel(const xr::ViewGroup& group, graph::ImageHandle image,
                            std::vector<xr::PanelPart> drawn) {
  const FrustumTangents& t = group.views.front().tangents;
  return {.name = "panels",
          .image = image,
          .lock = xr::PanelLayer::Lock::kHead,
          .pose = group.views.front().head_from_view *
                  Pose{{0.5 * (t.left + t.right), 0.5 * (t.bottom + t.top), -1.0}},
          .size_m = {t.right - t.left, t.top - t.bottom},
          .parts = std::move(drawn)};
}

}  // namespace

Console::Console(Session& session, xr::Overlay& overlay, const ConsoleOptions& options)
    : session_(session),
      overlay_(overlay),
      options_(options),
      participants_(participants_of(session.scene())) {
  std::erase_if(participants_, [](const Participant& one) { return !has_body(one); });
}

Result<std::unique_ptr<Console>> Console::create(Session& session, xr::Overlay& overlay,
                                                 const ConsoleOptions& options) {
  std::unique_ptr<Console> console(new Console(session, overlay, options));
  NERITIC_TRY(console->fans_, SonarFans::create(session.device()));
  return console;
}

void Console::take(const DiveInput& input) {
  if (input.toggle_help) {
    const std::size_t next = help_page_ ? *help_page_ + 1 : 0;
    if (next < help_pages_ || !help_page_)
      help_page_ = next;
    else
      help_page_.reset();
  }
  if (input.toggle_panels) show_panels_ = !show_panels_;
  if (input.toggle_times) show_times_ = !show_times_;
  first_sonar_ += input.next_sonar ? 1 : 0;
}

void Console::note(std::string text) {
  note_ = std::move(text);
  note_until_ns_ = now_ns() + kNote_ns;
}

void Console::look(const scene::MotionSource& motion, double time_s, const DivePilot& pilot,
                   const Vec3& eye_m) {
  if (!show_panels_) return;
  rows_.clear();
  for (const Participant& one : participants_) {
    const Motion at = motion.at(one.mount, time_s).motion;
    rows_.push_back({one.name, pilot.doing(static_cast<std::size_t>(one.mount.object)),
                     -at.pose.position_m.y, glm::length(at.velocity_m_s),
                     glm::distance(at.pose.position_m, eye_m)});
  }
}

Status Console::declare_sonars(graph::FrameGraph& graph, const SensorFrame& frame) {
  fans_->begin_frame();
  for (const SensorFrame::Sonar& ping : frame.sonars) {
    const scene::Sonar& sonar = session_.scene().sonars[ping.index];
    const bool fan =
        sonar.kind == scene::SonarKind::kImaging || sonar.kind == scene::SonarKind::kProfiling;
    if (fan) {
      NERITIC_TRY_STATUS(fans_->declare(graph, sonar.name, ping));
    } else {
      graph.output(ping.image, graph::Access::kStorageReadCompute);
    }
  }
  return {};
}

// "REC 1:07  FILE"; empty: nothing is recorded.
std::string Console::recording() const {
  const auto recorded = options_.keeper ? options_.keeper->recording() : std::nullopt;
  if (!recorded) return {};
  const auto seconds = static_cast<long>(recorded->seconds);
  return fmt::format("REC {}:{:02}  {}", seconds / 60, seconds % 60, recorded->file);
}

PanelFacts Console::facts(graph::FrameGraph& graph, const ConsoleFrame& frame) {
  const scene::Scene& scene = session_.scene();
  PanelFacts facts{.title = scene.title.empty() ? scene.path : scene.title,
                   .water = scene.water ? scene.water->type : "",
                   .view = frame.choice.viewpoint().name,
                   .pace = pace_words(options_.clock),
                   .width = frame.group.width,
                   .height = frame.group.height,
                   .view_scale = frame.view_scale,
                   .time_s = frame.time_s,
                   .speed_m_s = frame.choice.eye().speed_m_s(),
                   .participants = rows_,
                   .troubles = frame.pilot.troubles(),
                   .recording = recording()};
  for (const std::size_t index : options_.sonars) {
    const graph::ImageHandle picture = fans_->picture(graph, index);
    if (!picture) continue;
    facts.sonars.push_back({scene.sonars[index].name, overlay_.texture(picture),
                            *fans_->shape(index), *fans_->grid(index),
                            scene.sonars[index].rate_hz});
  }
  return facts;
}

void Console::draw(graph::FrameGraph& graph, const ConsoleFrame& frame) {
  const TimeNs now = now_ns();
  const float scale = overlay_.scale();
  const bool noted = now < note_until_ns_;
  if (help_page_) {
    help_pages_ = draw_help(dive_actions(), *help_page_, scale);
  } else if (show_panels_) {
    draw_panels(facts(graph, frame), frame.choice.eye(),
                {.first_sonar = first_sonar_,
                 .frames = &frame.times,
                 .device = show_times_ ? session_.device().info().name : "",
                 .hint = noted ? note_ : "F1  keys   V  view"},
                now, scale);
  } else {
    if (noted) draw_hint(note_, scale);
    if (const std::string light = recording(); !light.empty()) draw_recording_light(light, scale);
  }
}

Result<std::optional<xr::PanelLayer>> Console::declare(graph::FrameGraph& graph,
                                                       const ConsoleFrame& frame) {
  NERITIC_TRY_STATUS(overlay_.fit(frame.group.height));
  overlay_.begin(frame.group.width, frame.group.height, frame.elapsed_s);
  const bool noted = now_ns() < note_until_ns_;
  if (!show_panels_ && !help_page_ && !noted && recording().empty())
    return std::optional<xr::PanelLayer>();
  draw(graph, frame);
  const graph::ImageHandle image = overlay_.declare(graph);
  return std::optional(screen_panel(frame.group, image, overlay_.drawn()));
}

}  // namespace neritic::testbed
