// See gltf_images.hpp.
#include "engine/scene/gltf_images.hpp"

#include <algorithm>
#include <exception>
#include <system_error>

#include "engine/scene/gltf_json.hpp"
#include "engine/scene/image_file.hpp"

namespace neritic::scene::gltf {

void ImageDecoder::start(std::vector<Job> jobs) {
  jobs_ = std::move(jobs);
  const std::size_t n_cores = std::max(1u, std::thread::hardware_concurrency());
  const std::size_t n_threads = std::min({jobs_.size(), n_cores, std::size_t{8}});
  try {
    for (std::size_t i = 0; i < n_threads; ++i) threads_.emplace_back([this] { work(); });
  } catch (const std::system_error&) {
    // No more threads to be had: wait() does what is left.
  }
}

std::vector<ImageDecoder::Job>& ImageDecoder::wait() {
  work();
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
  return jobs_;
}

void ImageDecoder::work() {
  for (std::size_t i = next_++; i < jobs_.size(); i = next_++) decode(jobs_[i]);
}

void ImageDecoder::decode(Job& job) {
  if (!job.error.empty()) return;
  try {
    auto picture = decode_image8(job.bytes, job.name, 4);
    job.bytes = {};
    job.owned = {};
    if (picture.ok())
      job.picture = std::move(picture).value();
    else
      job.error = picture.error().message;
  } catch (const std::exception& exception) {  // out of memory; a thread must not throw
    job.error = fmt::format("{}: {}", job.name, one_line(exception.what()));
  }
}

}  // namespace neritic::scene::gltf
