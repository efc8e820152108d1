// Images of a World: who wants which, and the device that is made for the first of them.
#include "engine/core/refusal.hpp"
#include "testbed/world/world_parts.hpp"

namespace neritic::testbed {

Status World::Parts::make_session() {
  if (session) return {};
  gpu::DeviceOptions wanted;
  wanted.device = options.device;
  wanted.validation = options.validation;
  wanted.cache_folder = gpu::default_cache_folder();
  NERITIC_TRY(device, gpu::Device::create(wanted));
  displays = wrist_displays(physics, hud::Units::kMetric);
  NERITIC_TRY(session, Session::create(*device, scene, picture_places(displays.get())));
  image_receiver =
      std::make_unique<ImageReceiver>(*receiver, static_cast<std::uint32_t>(first_image), true);
  return {};
}

// The loop goes on with the images that are wished for now.
Status World::Parts::renew_consumer() {
  std::vector<ImageConsumer::Wish> wishes;
  for (const auto& [stream, rate_hz] : wished) wishes.push_back({streams[stream].name, rate_hz});
  if (attached()) return consumer->wish(wishes);
  std::optional<ImageConsumer> made;
  if (!wishes.empty()) {
    NERITIC_TRY(made, ImageConsumer::create(scene, wishes, *image_receiver));
  }
  end_loop();
  consumer = std::move(made);
  begin_loop();
  return {};
}

Status World::check_image(std::uint32_t stream, double rate_hz) const {
  NERITIC_CHECK(stream < parts_->streams.size(), "stream {}", stream);
  const StreamInfo& info = parts_->streams[stream];
  if (info.sort != StreamInfo::Sort::kImage)
    return refusal("images", info.name + ", which has none", "a stream of a camera or a sonar");
  if (info.kind == "motion")
    return refusal("images",
                   info.name + ", which leads to a picture that commands have yet to decide",
                   "color, depth, normals, labels, instances, echoes, echo_labels");
  return check_image_rate(info.name, info.rate_hz, rate_hz);
}

Status World::want_image(std::uint32_t stream, double rate_hz, bool keep) {
  NERITIC_TRY_STATUS(check_image(stream, rate_hz));
  Parts& parts = *parts_;
  if (!parts.attached()) NERITIC_TRY_STATUS(parts.make_session());
  const auto before = parts.wished;
  parts.wished[stream] = rate_hz;
  parts.receiver->kept[stream] = keep ? 1 : 0;
  const Status status = parts.renew_consumer();
  if (!status.ok()) parts.wished = before;
  return status;
}

Status World::drop_image(std::uint32_t stream) {
  Parts& parts = *parts_;
  if (parts.wished.erase(stream) == 0)
    return refusal("images", "a stream that is not wanted", "one of want_image()");
  return parts.renew_consumer();
}

ImageConsumer* World::images() {
  return parts_->attached() ? &*parts_->consumer : nullptr;
}

std::vector<std::unique_ptr<WorldImage>> World::take_images() {
  auto& images = parts_->receiver->images;
  std::vector<std::unique_ptr<WorldImage>> out(std::make_move_iterator(images.begin()),
                                               std::make_move_iterator(images.end()));
  images.clear();
  return out;
}

}  // namespace neritic::testbed
