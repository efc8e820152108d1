// Decodes a model's pictures on other threads while the meshes are read. The result does not depend
// on the number of threads. Owned and used by the loading thread.
#pragma once

#include <atomic>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "engine/core/image.hpp"
#include "engine/core/result.hpp"

namespace neritic::scene::gltf {

class ImageDecoder {
 public:
  struct Job {
    std::size_t image = 0;  // index in the file
    std::string name;       // for messages
    std::vector<std::byte> owned;
    std::span<const std::byte> bytes;  // owned, or a buffer view's, which must outlive the decoder
    std::string error;                 // given: there is nothing to decode
    // Filled in by a worker, like error.
    ImageU8 picture;
  };

  ImageDecoder() = default;
  ~ImageDecoder() {
    next_ = jobs_.size();  // a failed load wants no more pictures
    wait();
  }
  ImageDecoder(const ImageDecoder&) = delete;
  ImageDecoder& operator=(const ImageDecoder&) = delete;

  // Call once; returns at once.
  void start(std::vector<Job> jobs);
  // Helps with what is left, then returns all jobs, in the order given.
  std::vector<Job>& wait();

 private:
  void work();
  static void decode(Job& job);

  std::vector<Job> jobs_;
  std::atomic<std::size_t> next_{0};
  std::vector<std::thread> threads_;
};

}  // namespace neritic::scene::gltf
