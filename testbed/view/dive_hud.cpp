#include "testbed/view/dive_hud.hpp"

#include <algorithm>
#include <cmath>

#include "diver/frames.hpp"
#include "testbed/instruments/instrument_data.hpp"

namespace neritic::testbed {
namespace {

// A rectangle of the view, in pixels from its left and top, as a panel a metre ahead.
xr::PanelLayer over_pixels(const xr::ViewGroup& group, double left, double top, double width,
                           double height) {
  const FrustumTangents& t = group.views.front().tangents;
  const double across = (t.right - t.left) / group.width, down = (t.top - t.bottom) / group.height;
  const Vec3 centre(t.left + across * (left + 0.5 * width), t.top - down * (top + 0.5 * height),
                    -1.0);
  return {.lock = xr::PanelLayer::Lock::kHead,
          .pose = group.views.front().head_from_view * Pose{centre},
          .size_m = {across * width, down * height}};
}

// By this the wrist's instrument lies higher before the eyes where the mask's is shown as well:
// clear of it for each eye, up to 74 mm apart, at the same distance.
constexpr double kAboveMask_rad = 0.4;

// Where in the view the gaze goes, 0 to 1 from left and top; nothing where it is not measured or
// goes elsewhere.
std::optional<Vec2> gaze_in(const std::optional<Vec3>& gaze, const HudView& view) {
  if (!gaze) return {};
  const FrustumTangents& t = view.group.views.front().tangents;
  const Vec3 ahead = glm::conjugate(view.world_from_view.rotation) * *gaze;
  if (!(ahead.z < 0.0)) return {};
  const Vec2 at((-ahead.x / ahead.z - t.left) / (t.right - t.left),
                (t.top + ahead.y / ahead.z) / (t.top - t.bottom));
  if (!(at.x >= 0.0 && at.x <= 1.0 && at.y >= 0.0 && at.y <= 1.0)) return {};
  return at;
}

void record_upload(const ImageU8& picture, const gpu::Image& image, gpu::Commands& commands) {
  const gpu::UploadSlice texels = commands.upload(std::span<const std::uint8_t>(picture.data));
  VkBufferImageCopy region{};
  region.bufferOffset = texels.offset;
  region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  region.imageExtent = {picture.width, picture.height, 1};
  vkCmdCopyBufferToImage(commands.handle(), texels.buffer, image.handle(),
                         VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
}

// The upload of an instrument's picture; every texel is written.
graph::ImageHandle declare_upload(graph::FrameGraph& graph, const ImageU8& picture,
                                  const gpu::Image& image) {
  const graph::ImageHandle target = graph.import_image(image, {});
  struct Data {
    graph::ImageHandle image;
  };
  return graph
      .add_pass<Data>(
          image.desc().name,
          [&](graph::PassBuilder& builder, Data& data) {
            data.image = builder.write(target, graph::Access::kTransferWrite);
          },
          [&picture](const Data& data, graph::PassContext& context) {
            record_upload(picture, context.image(data.image), context.commands);
          })
      .image;
}

// As large as a place lets, in its middle: pixels of the console's picture from its left and top.
VkRect2D fit(const hud::Box& place, const ConsolePicture& picture, double scale) {
  const double wide = std::min(place.w, place.h * picture.width / picture.height);
  const double high = wide * picture.height / picture.width;
  const auto px = [scale](double v) { return static_cast<std::int32_t>(std::lround(scale * v)); };
  const std::int32_t left = px(place.x + 0.5 * (place.w - wide)),
                     top = px(place.y + 0.5 * (place.h - high));
  return {{left, top},
          {static_cast<std::uint32_t>(std::max(1, px(wide))),
           static_cast<std::uint32_t>(std::max(1, px(high)))}};
}

// A picture into a rectangle of another, scaled.
graph::ImageHandle declare_copy(graph::FrameGraph& graph, const char* name,
                                const ConsolePicture& from, const VkRect2D& rect,
                                graph::ImageHandle onto) {
  struct Data {
    graph::ImageHandle from, onto;
  };
  return graph
      .add_pass<Data>(
          name,
          [&](graph::PassBuilder& builder, Data& data) {
            data.from = from.image;
            builder.read(from.image, graph::Access::kTransferRead);
            data.onto = builder.write(onto, graph::Access::kTransferWrite);
          },
          [from, rect](const Data& data, graph::PassContext& context) {
            VkImageBlit region{};
            region.srcSubresource = region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
            region.srcOffsets[1] = {static_cast<std::int32_t>(from.width),
                                    static_cast<std::int32_t>(from.height), 1};
            region.dstOffsets[0] = {rect.offset.x, rect.offset.y, 0};
            region.dstOffsets[1] = {rect.offset.x + static_cast<std::int32_t>(rect.extent.width),
                                    rect.offset.y + static_cast<std::int32_t>(rect.extent.height),
                                    1};
            vkCmdBlitImage(context.commands.handle(), context.image(data.from).handle(),
                           VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, context.image(data.onto).handle(),
                           VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region, VK_FILTER_LINEAR);
          })
      .onto;
}

// The source of a dive in this process.
class PhysicsFeed final : public InstrumentFeed {
 public:
  PhysicsFeed(LivePhysics& physics, std::size_t diver, const Devices* devices)
      : physics_(physics), diver_(diver), devices_(devices) {}
  double time_s() const override { return physics_.shown_snapshot().time_s; }
  InstrumentNews read() override {
    const sim::Snapshot<PhysicsState>& snapshot = physics_.shown_snapshot();
    const HumanPhysics& diver = snapshot.state.humans()[diver_];
    const auto sources = physics_.inbox().source_names();
    InstrumentNews news{
        instrument_data(physics_.world(), diver_, snapshot), stream_health(diver, sources), {}};
    if (devices_ && !devices_->empty()) add_links(diver, devices_->health(), sources, news.streams);
    const diver::VitalState& vitals = diver.human.life.vitals;
    if ((vitals.measured & diver::kGazeMeasured) != 0)
      news.gaze = diver::world_from_ned(vitals.gaze_ned);
    return news;
  }

 private:
  LivePhysics& physics_;
  std::size_t diver_;
  const Devices* devices_;
};

}  // namespace

DiveHud::DiveHud(gpu::Device& device, gpu::Frames& frames, LivePhysics& physics,
                 DiveHudOptions options, const Devices* devices)
    : DiveHud(device, frames, std::make_unique<PhysicsFeed>(physics, options.diver, devices),
              options) {}

DiveHud::DiveHud(gpu::Device& device, gpu::Frames& frames, std::unique_ptr<InstrumentFeed> feed,
                 DiveHudOptions options)
    : device_(device), frames_(frames), feed_(std::move(feed)), options_(std::move(options)) {
  for (const hud::Layout& layout : hud::layouts())
    instruments_.push_back({hud::Hud(layout.kind, options_.units, layout.height_px), 0, {}});
}

bool DiveHud::shown(hud::LayoutKind layout) const {
  if (choice_ > 0) return choice_ - 1 == static_cast<std::size_t>(layout);
  return std::ranges::find(options_.layouts, layout) != options_.layouts.end();
}

std::vector<HudPlace> DiveHud::places(const xr::ViewGroup& group) const {
  std::vector<hud::LayoutKind> kinds;
  for (const Instrument& instrument : instruments_)
    if (shown(instrument.hud.layout().kind)) kinds.push_back(instrument.hud.layout().kind);
  return hud_places(kinds, group.width, group.height);
}

std::vector<PanelRect> DiveHud::taken(const xr::ViewGroup& group) const {
  std::vector<PanelRect> out;
  for (const HudPlace& place : places(group)) {
    const auto& hud = instruments_[static_cast<std::size_t>(place.kind)].hud;
    std::ranges::copy(taken_by(place, hud.shown()), std::back_inserter(out));
  }
  return out;
}

void DiveHud::cycle() {
  choice_ = (choice_ + 1) % (instruments_.size() + 2);
}

// Whether the picture that is seen then may change: by new numbers, or as a danger flashes.
bool DiveHud::is_due(double seen_s) const {
  const bool flashes =
      hud::flash_at(seen_s) != flash_ &&
      std::ranges::any_of(instruments_, [](const Instrument& i) { return i.hud.flashes(); });
  const double after_s = next_seen_s_ - seen_s;
  // Where the viewer's clock begins anew, it begins now.
  return flashes || after_s <= 1e-9 || after_s > 1.0 / kHudRate_hz + 1e-9;
}

// Whether the feed was read. anew: a picture is made of it.
bool DiveHud::look(const HudView& view, bool anew) {
  const double time_s = feed_->time_s();
  // A state that was restored may lie before the last one.
  if (!anew && time_s < next_s_ - 1e-9 && time_s >= data_.time_s) return false;
  InstrumentNews news = feed_->read();
  data_ = news.data;
  streams_ = std::move(news.streams);
  about_ = {.gaze = gaze_in(news.gaze, view),
            .streams = streams_,
            .sonar = std::string_view(options_.sonar),
            .camera = std::string_view(options_.camera)};
  next_s_ = data_.time_s + 1.0 / kHudRate_hz;
  return true;
}

Status DiveHud::declare(graph::FrameGraph& graph, const HudView& view,
                        std::vector<xr::Layer>& layers) {
  const bool anew = is_due(view.seen_s);
  if (anew) {
    flash_ = hud::flash_at(view.seen_s);
    next_seen_s_ = view.seen_s + 1.0 / kHudRate_hz;
  }
  const bool heard = look(view, anew);
  const auto in_window = view.tracked ? std::vector<HudPlace>() : places(view.group);
  for (Instrument& instrument : instruments_) {
    const hud::Layout& layout = instrument.hud.layout();
    const auto found = std::ranges::find(in_window, layout.kind, &HudPlace::kind);
    const PanelRect rect = found == in_window.end() ? PanelRect() : found->rect;
    if (!shown(layout.kind) || (!view.tracked && rect.empty())) {
      if (heard) instrument.hud.observe(data_, view.seen_s);
      continue;
    }
    const std::uint32_t height_px =
        view.tracked ? layout.height_px : static_cast<std::uint32_t>(rect.height);
    NERITIC_TRY(const graph::ImageHandle image,
                declare_picture(graph, instrument, height_px, anew, view));
    layers.push_back(place(instrument, view, rect));
    std::get<xr::PanelLayer>(layers.back()).image = image;
  }
  return {};
}

// The image for the hud's picture; one of another size lives until the GPU is done with it.
Status DiveHud::make_image(Instrument& instrument) {
  if (instrument.image)
    frames_.retire([old = std::make_shared<gpu::Image>(std::move(instrument.image))]() mutable {
      old.reset();
    });
  const ImageU8& picture = instrument.hud.picture();
  NERITIC_TRY(instrument.image,
              gpu::Image::create(
                  device_, {.name = fmt::format("hud {}", instrument.hud.layout().name),
                            .format = VK_FORMAT_R8G8B8A8_UNORM,
                            .width = picture.width,
                            .height = picture.height,
                            .usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                                     VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                            .array_view = true}));
  return {};
}

Result<graph::ImageHandle> DiveHud::declare_picture(graph::FrameGraph& graph,
                                                    Instrument& instrument, std::uint32_t height_px,
                                                    bool anew, const HudView& view) {
  const bool resized = height_px != instrument.height_px;
  if (resized) {
    instrument.hud.resize(height_px);
    instrument.height_px = height_px;
    NERITIC_TRY_STATUS(make_image(instrument));
  }
  const bool changed = (anew || resized) && instrument.hud.update(data_, view.seen_s, about_);
  if (!anew && !resized) instrument.hud.observe(data_, view.seen_s);
  graph::ImageHandle image =
      changed ? declare_upload(graph, instrument.hud.picture(), instrument.image)
              : graph.import_image(instrument.image,
                                   {.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});
  if (anew && instrument.hud.layout().kind == hud::LayoutKind::kConsole)
    lay_over(graph, instrument, view, image);
  // Whatever the display does with it, the next frame finds it as it imports it.
  graph.output(image, graph::Access::kSampledFragment);
  return image;
}

// The sonar's and the camera's pictures in their places of the console.
void DiveHud::lay_over(graph::FrameGraph& graph, const Instrument& instrument, const HudView& view,
                       graph::ImageHandle& image) const {
  const hud::Shown& shown = instrument.hud.shown();
  const double scale =
      static_cast<double>(instrument.height_px) / instrument.hud.layout().height_px;
  const auto lay = [&](const char* name, const std::optional<hud::Box>& place,
                       const ConsolePicture& picture) {
    if (place && picture.image)
      image = declare_copy(graph, name, picture, fit(*place, picture, scale), image);
  };
  lay("hud sonar", hud::sonar_place(shown), view.sonar);
  lay("hud camera", hud::camera_place(shown), view.camera);
}

xr::PanelLayer DiveHud::place(const Instrument& instrument, const HudView& view,
                              const PanelRect& rect) const {
  const hud::Layout& layout = instrument.hud.layout();
  const ImageU8& picture = instrument.hud.picture();
  if (!view.tracked) {
    xr::PanelLayer panel = over_pixels(view.group, rect.x, rect.y, picture.width, picture.height);
    panel.name = layout.name;
    return panel;
  }
  xr::PanelLayer panel{
      .name = std::string(layout.name), .size_m = layout.size_m, .radius_m = layout.radius_m};
  switch (layout.lock) {
    case hud::Lock::kHead:
      panel.pose = layout.lock_from_panel;
      break;
    case hud::Lock::kWrist:
      if (view.world_from_wrist) {
        panel.lock = xr::PanelLayer::Lock::kWorld;
        panel.pose = *view.world_from_wrist * layout.lock_from_panel;
      } else {
        const bool masked = shown(hud::LayoutKind::kMask);
        panel.pose = Pose{Vec3(0.0), from_yaw_pitch_roll(0.0, masked ? kAboveMask_rad : 0.0, 0.0)} *
                     layout.head_from_panel;
      }
      break;
    case hud::Lock::kWorld:
      panel.lock = xr::PanelLayer::Lock::kWorld;
      panel.pose = view.world_from_stage *
                   (view.stage_at_eyes ? layout.head_from_panel : layout.lock_from_panel);
      break;
  }
  return panel;
}

}  // namespace neritic::testbed
