#include "testbed/view/console.hpp"

#include <imgui_internal.h>

#include <cmath>

#include "testbed/instruments/instrument_data.hpp"
#include "testbed/view/help_panel.hpp"
#include "testbed/view/key_words.hpp"
#include "testbed/view/panel_frame.hpp"

namespace neritic::testbed {
namespace {

constexpr TimeNs kNote_ns = 5'000'000'000;  // how long a note stays on the screen
constexpr double kGainStep_db = 3.0, kMostGain_db = 24.0;

// "paused", "0.5 x speed"; empty at the host's pace.
std::string pace_words(sim::RunClock* clock) {
  if (!clock) return {};
  if (clock->paused()) return "paused";
  return clock->speed() == 1.0 ? std::string() : fmt::format("{:g} x speed", clock->speed());
}

// How far a picture may be ahead of the newest state in time that runs fast: one of slow pictures
// is shown half a second of the host after its state.
double usual_lag_s(sim::RunClock* clock) {
  constexpr double kSlowPicture_s = 0.5;
  const double speed = clock ? clock->speed() : 1.0;
  return speed > 1.0 ? kSlowPicture_s * speed : 0.0;
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
  const ViewMemory& memory = options_.memory;
  show_panels_ = memory.panels && options_.task.empty(), show_times_ = memory.times;
  show_map_ = memory.map, show_graphs_ = memory.graphs;
  graphs_.names = memory.numbers;
  gain_db_ = memory.sonar_gain_db, range_part_ = memory.sonar_range_part;
}

Result<std::unique_ptr<Console>> Console::create(Session& session, xr::Overlay& overlay,
                                                 const ConsoleOptions& options) {
  std::unique_ptr<Console> console(new Console(session, overlay, options));
  NERITIC_TRY(console->fans_, SonarFans::create(session.device()));
  console->show_sonars();
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
  if (input.toggle_map) show_map_ = !show_map_;
  if (input.toggle_graphs) toggle_graphs();
  if (input.next_inset) {
    const std::size_t next = inset_ ? *inset_ + 1 : 0;
    inset_ = next < session_.scene().cameras.size() ? std::optional(next) : std::nullopt;
  }
  work_sonars(input);
}

// What is not there is not turned on unseen for a later dive.
void Console::toggle_graphs() {
  if (options_.physics)
    show_graphs_ = !show_graphs_;
  else
    note("nothing moves by physics: there are no numbers for graphs");
}

void Console::work_sonars(const DiveInput& input) {
  const bool settings = input.gain_step != 0 || input.next_range;
  if (!settings && !input.next_sonar) return;
  if (options_.sonars.empty()) return note("no sonar is shown here");
  if (input.next_sonar && options_.sonars.size() == 1) note("no other sonar is shown here");
  first_sonar_ += input.next_sonar ? 1 : 0;
  if (!settings) return;
  gain_db_ = std::clamp(gain_db_ + kGainStep_db * input.gain_step, -kMostGain_db, kMostGain_db);
  if (input.next_range) range_part_ = range_part_ > 0.3 ? 0.5 * range_part_ : 1.0;
  show_sonars();
}

// The sonars' pictures as gain and range are now.
void Console::show_sonars() {
  fans_->show(std::pow(10.0, gain_db_ / 20.0), range_part_);
}

void Console::mark(Picked picked) {
  picked_ = std::move(picked);
  picked_until_ns_ = now_ns() + kNote_ns;
}

ViewMemory Console::memory() const {
  ViewMemory out = options_.memory;
  out.panels = show_panels_, out.times = show_times_;
  out.map = show_map_, out.graphs = show_graphs_;
  out.numbers = graphs_.names;
  out.sonar_gain_db = gain_db_, out.sonar_range_part = range_part_;
  return out;
}

void Console::note(std::string text) {
  note_ = std::move(text);
  note_until_ns_ = now_ns() + kNote_ns;
}

// What the instruments of a diver show; nothing for another object.
std::optional<DiverGauge> Console::diver_gauge(int object) const {
  if (!options_.physics) return {};
  const auto& humans = options_.physics->world().humans();
  for (std::size_t i = 0; i < humans.size(); ++i)
    if (static_cast<int>(humans[i].object) == object)
      return gauge_of(humans[i], options_.physics->shown().humans()[i]);
  return {};
}

void Console::look(const scene::MotionSource& motion, double time_s, const DivePilot& pilot,
                   const Vec3& eye_m) {
  if (!show_panels_) return;
  rows_.clear();
  marks_.clear();
  for (const Participant& one : participants_) {
    scene::MotionAt seen = motion.at(one.mount, time_s);
    const double behind_s = seen.predicted_s;
    const bool held = seen.known == scene::Knowledge::kHeld && behind_s > 0.0;
    // Beyond what is predicted nothing moves: the newest state says how it does.
    if (held) seen = motion.at(one.mount, time_s - behind_s);
    const Motion& at = seen.motion;
    std::string doing = pilot.doing(static_cast<std::size_t>(one.mount.object), options_.units);
    // In fast time the picture's time is ahead of the newest state by so much.
    if (held && behind_s > usual_lag_s(options_.clock))
      doing += fmt::format("{}no state for {:.1f} s", doing.empty() ? "" : ", ", behind_s);
    double depth_m = -at.pose.position_m.y, course_rad = -course_of(at.pose.rotation);
    if (const auto gauge = diver_gauge(one.mount.object)) {
      course_rad = gauge->heading_rad;
      if (depth_m > 0.0) depth_m = gauge->depth_m;  // above water the gauge says nothing
    }
    rows_.push_back({one.name, std::move(doing), depth_m, glm::length(at.velocity_m_s),
                     glm::distance(at.pose.position_m, eye_m)});
    marks_.push_back({one.name, at.pose.position_m, course_rad});
  }
  trails_.add(marks_, time_s);
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
  return fans_->redraw(graph);
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
  PanelFacts facts{
      .title = scene.title.empty() ? scene.path : scene.title,
      .water = scene.water ? scene.water->type : "",
      .view = frame.worn < 0
                  ? frame.choice.viewpoint().name
                  : "of the wearer, " + scene.objects[static_cast<std::size_t>(frame.worn)].name,
      .pace = pace_words(options_.clock),
      .width = frame.group.width,
      .height = frame.group.height,
      .given_up = given_up(frame.quality, !options_.sonars.empty()),
      .time_s = frame.time_s,
      .speed_m_s = frame.choice.eye().speed_m_s(),
      .participants = rows_,
      .troubles = frame.pilot.troubles(),
      .recording = recording()};
  if (options_.devices)
    for (const DeviceHealth& health : options_.devices->health())
      facts.devices.push_back(stream_words(health, now_ns()));
  for (const std::size_t index : options_.sonars) {
    const graph::ImageHandle picture = fans_->picture(graph, index);
    if (!picture) continue;
    facts.sonars.push_back({scene.sonars[index].name, overlay_.texture(picture),
                            *fans_->shape(index), *fans_->grid(index),
                            scene.sonars[index].rate_hz / frame.quality.ping_every});
  }
  return facts;
}

// The depth and heading of the participant that carries the view or is chased; in a free view those
// of the view itself.
Readout Console::readout(const ConsoleFrame& frame) const {
  const FreeCamera& eye = frame.choice.eye();
  Readout out{"camera", -eye.position_m().y, radians(eye.heading_deg()), 2};
  const int carrier = frame.worn < 0 ? frame.choice.carrier() : frame.worn;
  for (std::size_t i = 0; i < participants_.size() && i < marks_.size(); ++i)
    if (carrier >= 0 && carrier_of(session_.scene(), participants_[i].mount) == carrier)
      return {marks_[i].name, rows_[i].depth_m, marks_[i].course_rad, 1};
  return out;
}

// Panels that the user asked for, or that steering needs.
void Console::add_on_demand(graph::FrameGraph&, const ConsoleFrame& frame, PanelFacts& facts) {
  facts.sonar_gain_db = gain_db_;
  facts.marks = marks_;
  facts.units = options_.units;
  facts.readout = readout(frame);
  facts.eye = {"", frame.choice.eye().position_m(), radians(frame.choice.eye().heading_deg())};
  if (frame.world_from_head)
    facts.eye = {"", frame.world_from_head->position_m,
                 -course_of(frame.world_from_head->rotation)};
  if (frame.inset && inset_) {
    const scene::Camera& camera = session_.scene().cameras[*inset_];
    facts.inset = InsetPanel{camera.name, overlay_.texture(frame.inset),
                             static_cast<float>(camera.height) / static_cast<float>(camera.width)};
  }
  if (!options_.physics) return;
  numbers_.look(options_.physics->world(), options_.physics->shown_snapshot(),
                frame.times.frame().smooth_ms, frame.quality.view_scale);
  if (graphs_.names.empty() && show_graphs_ && !numbers_.all().empty())
    graphs_.names.push_back(numbers_.all().front().name);
  const auto& vehicles = options_.physics->world().vehicles();
  for (std::size_t i = 0; i < vehicles.size() && frame.pilot.flying(); ++i)
    if (static_cast<int>(vehicles[i].object) == frame.pilot.object())
      facts.gauges = gauges_of(options_.physics->world(), options_.physics->shown(), i);
}

// A ring around what was clicked, and what it is beside it, off panels and instruments.
void Console::draw_mark(TimeNs now_ns, float scale, std::span<const PanelRect> instruments) const {
  if (!picked_ || now_ns >= picked_until_ns_) return;
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  ImDrawList& list = *ImGui::GetForegroundDrawList();
  const ImVec2 at(static_cast<float>(picked_->at.x) * display.x,
                  static_cast<float>(picked_->at.y) * display.y);
  const ImVec2 text = ImGui::CalcTextSize(picked_->words.c_str());
  const float pad = 6.0f * scale;
  std::vector<PanelRect> taken(instruments.begin(), instruments.end());
  for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows)
    if (window->Active && !window->Hidden)
      taken.push_back({window->Pos.x, window->Pos.y, window->Size.x, window->Size.y});
  list.AddCircle(at, 7.0f * scale, kMark, 0, 2.0f * scale);
  PanelRect place =
      label_place({at.x, at.y}, 10.0f * scale, {text.x + 2.0f * pad, text.y + 2.0f * pad},
                  {0.0f, 0.0f, display.x, display.y}, taken);
  if (place.empty())  // over what is there rather than nowhere
    place = {std::clamp(at.x, 0.0f, std::max(0.0f, display.x - text.x - 2.0f * pad)), at.y,
             text.x + 2.0f * pad, text.y + 2.0f * pad};
  list.AddRectFilled(ImVec2(place.x, place.y), ImVec2(place.right(), place.bottom()), kPaper,
                     4.0f * scale);
  list.AddText(ImVec2(place.x + pad, place.y + pad), kInk, picked_->words.c_str());
}

// A click into the picture, and the panel that the cursor is over.
void Console::look_at_cursor() {
  const ImGuiIO& io = ImGui::GetIO();
  const ImVec2 display = io.DisplaySize;
  hovered_.reset();
  if (const ImGuiWindow* const window = ImGui::GetCurrentContext()->HoveredWindow) {
    const ImGuiWindow& root = *window->RootWindow;
    hovered_ = {root.Pos.x / display.x, root.Pos.y / display.y,
                (root.Pos.x + root.Size.x) / display.x, (root.Pos.y + root.Size.y) / display.y};
  }
  if (!io.WantCaptureMouse && ImGui::IsMousePosValid() && ImGui::IsMouseClicked(0))
    clicked_ = {io.MousePos.x / display.x, io.MousePos.y / display.y};
}

// The line under the panels when there is nothing to note: the task, or the first keys to know.
std::string Console::standing_hint(bool worn) const {
  if (!options_.task.empty()) return options_.task;
  return first_keys(options_.actions, !worn, options_.steers);
}

void Console::draw(graph::FrameGraph& graph, const ConsoleFrame& frame) {
  const TimeNs now = now_ns();
  const float scale = overlay_.scale();
  const bool noted = now < note_until_ns_;
  if (help_page_) {
    help_pages_ = draw_help(options_.actions, *help_page_, scale);
  } else if (show_panels_) {
    PanelFacts facts = this->facts(graph, frame);
    add_on_demand(graph, frame, facts);
    const bool graphs = show_graphs_ && options_.physics;
    draw_panels(facts,
                {.first_sonar = first_sonar_,
                 .next_sonar = key_of(options_.actions, "next_sonar"),
                 .frames = &frame.times,
                 .device = show_times_ ? session_.device().info().name : "",
                 .hint = noted ? note_ : standing_hint(frame.world_from_head.has_value()),
                 .trails = show_map_ ? &trails_ : nullptr,
                 .numbers = graphs ? &numbers_ : nullptr,
                 .taken = frame.taken,
                 .graphs = graphs ? &graphs_ : nullptr},
                now, scale);
  } else {
    if (noted)
      draw_hint(note_, scale);
    else if (!options_.task.empty())
      draw_task(options_.task, scale);
    if (const std::string light = recording(); !light.empty()) draw_recording_light(light, scale);
  }
}

Result<std::optional<xr::PanelLayer>> Console::declare(graph::FrameGraph& graph,
                                                       const ConsoleFrame& frame) {
  NERITIC_TRY_STATUS(overlay_.fit(frame.group.height));
  overlay_.begin(frame.group.width, frame.group.height, frame.elapsed_s);
  look_at_cursor();
  const TimeNs now = now_ns();
  const bool noted = now < note_until_ns_ || (picked_ && now < picked_until_ns_);
  if (!show_panels_ && !help_page_ && !noted && options_.task.empty() && recording().empty())
    return std::optional<xr::PanelLayer>();
  draw(graph, frame);
  if (!help_page_) draw_mark(now, overlay_.scale(), frame.taken);
  const graph::ImageHandle image = overlay_.declare(graph);
  return std::optional(screen_panel(frame.group, image, overlay_.drawn()));
}

}  // namespace neritic::testbed
