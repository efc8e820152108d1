#include "sonar/ping_labels.hpp"

#include "engine/core/check.hpp"
#include "engine/core/files.hpp"
#include "engine/core/npy.hpp"

namespace neritic::sonar {
namespace {

template <class T>
void append_reversed(std::vector<T>& out, const std::vector<T>& values) {
  out.insert(out.end(), values.rbegin(), values.rend());
}
template <class T>
void append_all(std::vector<T>& out, const std::vector<T>& values) {
  out.insert(out.end(), values.begin(), values.end());
}

}  // namespace

PingLine ping_line(const LabelImage& labels, std::span<const float> intensity) {
  NERITIC_CHECK(labels.n_beams == 1 && intensity.size() == labels.n_range,
                "{} values, labels of {} bins and {} beams", intensity.size(), labels.n_range,
                labels.n_beams);
  return {labels.classes, labels.instances, {intensity.begin(), intensity.end()}};
}

PingLine ping_line(const PingLine& port, const PingLine& starboard) {
  PingLine out;
  append_reversed(out.classes, port.classes);
  append_reversed(out.instances, port.instances);
  append_reversed(out.intensity, port.intensity);
  append_all(out.classes, starboard.classes);
  append_all(out.instances, starboard.instances);
  append_all(out.intensity, starboard.intensity);
  return out;
}

void PingLabels::append(const PingLine& line) {
  if (pings_ == 0) bins_ = line.classes.size();
  NERITIC_CHECK(bins_ > 0 && line.classes.size() == bins_ && line.instances.size() == bins_ &&
                    line.intensity.size() == bins_,
                "a ping of {} bins after others of {}", line.classes.size(), bins_);
  append_all(classes_, line.classes);
  append_all(instances_, line.instances);
  append_all(intensity_, line.intensity);
  ++pings_;
}

template <class T>
std::vector<T> PingLabels::laid(const std::vector<T>& lines, std::size_t first, std::size_t count,
                                PingsAlong along) const {
  std::vector<T> out(count * bins_);
  for (std::size_t ping = 0; ping < count; ++ping)
    for (std::size_t bin = 0; bin < bins_; ++bin)
      out[along == PingsAlong::kRows ? ping * bins_ + bin : bin * count + ping] =
          lines[(first + ping) * bins_ + bin];
  return out;
}

Status PingLabels::write(const std::filesystem::path& folder, const std::string& prefix,
                         PingsAlong along) const {
  const auto write = [&](const char* what, const std::vector<std::uint16_t>& lines) {
    const std::vector<std::uint16_t> values = laid(lines, 0, pings_, along);
    const std::filesystem::path path = folder / (prefix + what);
    const std::span<const std::uint16_t> all(values);
    return along == PingsAlong::kRows ? write_npy(path, all, {pings_, bins_})
                                      : write_npy(path, all, {bins_, pings_});
  };
  NERITIC_TRY_STATUS(make_folder(folder));
  NERITIC_TRY_STATUS(write("_labels.npy", classes_));
  return write("_instances.npy", instances_);
}

ImageU16 PingLabels::classes(PingsAlong along) const {
  ImageU16 out;
  out.width = static_cast<std::uint32_t>(along == PingsAlong::kRows ? bins_ : pings_);
  out.height = static_cast<std::uint32_t>(along == PingsAlong::kRows ? pings_ : bins_);
  out.data = laid(classes_, 0, pings_, along);
  return out;
}

Status PingLabels::add_to(CocoFile& coco, CocoPictures& pictures, PingsAlong along) const {
  for (std::size_t first = 0; first < pings_; first += kPingsAPicture) {
    const std::size_t count = std::min(kPingsAPicture, pings_ - first);
    auto height = static_cast<std::uint32_t>(count), width = static_cast<std::uint32_t>(bins_);
    if (along == PingsAlong::kColumns) std::swap(width, height);
    const std::string name = fmt::format("coco/pings_{:05}.png", first);
    coco.add(name, {height,
                    width,
                    laid(classes_, first, count, along),
                    laid(instances_, first, count, along),
                    {}});
    NERITIC_TRY_STATUS(
        pictures.add(name, {height, width, laid(intensity_, first, count, along), {}}));
  }
  return {};
}

}  // namespace neritic::sonar
