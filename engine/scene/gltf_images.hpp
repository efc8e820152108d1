// Decodes a model's pictures on other threads while the meshes are read. The result does not depend
// on the number of threads. Owned and used by the loading thread.
#pragma once

#include <atomic>
#include <filesystem>
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
    std::size_t image = 0;             // index in the file
    std::span<const std::byte> bytes;  // of a buffer view; must outlive the decoder, or
    std::string uri;                   // a data URI or relative path
    // Filled in by a worker.
    ImageU8 picture;
    std::string error;
  };

  ImageDecoder(std::string file, std::filesystem::path folder)
      : file_(std::move(file)), folder_(std::move(folder)) {}
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
  void decode(Job& job) const;

  std::string file_;
  std::filesystem::path folder_;
  std::vector<Job> jobs_;
  std::atomic<std::size_t> next_{0};
  std::vector<std::thread> threads_;
};

}  // namespace neritic::scene::gltf
