// Notes every Vulkan object of a device that is made while it lives, and the name it is given, by
// standing between the program and volk's table of functions. For devices that are created while it
// lives, after another (whose creation filled the table). One at a time, one thread.
#pragma once

#include <volk.h>

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace neritic::test {

class VulkanRecord {
 public:
  VulkanRecord();
  ~VulkanRecord();
  VulkanRecord(const VulkanRecord&) = delete;
  VulkanRecord& operator=(const VulkanRecord&) = delete;

  // The type and handle of each that was made and not named before its handle came again.
  std::vector<std::string> unnamed() const;
  std::size_t made(VkObjectType type) const;
  struct MadeImage {
    VkFormat format;
    VkImageUsageFlags usage;
  };
  const std::vector<MadeImage>& images() const { return images_; }

  // For the functions that stand in.
  void note_made(VkObjectType type, std::uint64_t handle);
  void note_named(VkObjectType type, std::uint64_t handle, const char* name);
  void note_image(const MadeImage& image) { images_.push_back(image); }

 private:
  struct Made {
    VkObjectType type;
    std::uint64_t handle;
    std::string name;
  };
  std::vector<Made> made_;
  std::map<std::pair<VkObjectType, std::uint64_t>, std::size_t> newest_;
  std::vector<MadeImage> images_;
};

}  // namespace neritic::test
