#include "engine/gpu/pipeline_cache.hpp"

#include <array>
#include <cstring>
#include <string>

#include "engine/core/hash.hpp"

namespace neritic::gpu {
namespace {

constexpr std::array<char, 8> kMagic{'N', 'E', 'R', 'P', 'I', 'P', 'E', '1'};
constexpr std::size_t kPrefixBytes = kMagic.size() + sizeof(std::uint64_t);

std::uint64_t checksum(std::span<const std::byte> data) {
  Hash64 hash;
  hash.add_span(data);
  return hash.value();
}

std::string hex(std::span<const std::uint8_t> bytes) {
  std::string out;
  for (const std::uint8_t byte : bytes) out += fmt::format("{:02x}", byte);
  return out;
}

}  // namespace

std::filesystem::path pipeline_cache_file(const std::filesystem::path& folder,
                                          VkPhysicalDevice device) {
  VkPhysicalDeviceIDProperties id{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ID_PROPERTIES};
  VkPhysicalDeviceProperties2 all{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &id};
  vkGetPhysicalDeviceProperties2(device, &all);
  return folder / fmt::format("pipelines-{:04x}-{:04x}-{:x}-{}-{}.bin", all.properties.vendorID,
                              all.properties.deviceID, all.properties.driverVersion,
                              hex(id.driverUUID), hex(all.properties.pipelineCacheUUID));
}

std::vector<std::byte> unpack_cache(std::span<const std::byte> file,
                                    const VkPhysicalDeviceProperties& properties) {
  if (file.size() < kPrefixBytes + sizeof(VkPipelineCacheHeaderVersionOne)) return {};
  if (std::memcmp(file.data(), kMagic.data(), kMagic.size()) != 0) return {};
  std::uint64_t expected = 0;
  std::memcpy(&expected, file.data() + kMagic.size(), sizeof expected);
  const auto data = file.subspan(kPrefixBytes);
  if (checksum(data) != expected) return {};
  VkPipelineCacheHeaderVersionOne header{};
  std::memcpy(&header, data.data(), sizeof header);
  if (header.headerVersion != VK_PIPELINE_CACHE_HEADER_VERSION_ONE ||
      header.vendorID != properties.vendorID || header.deviceID != properties.deviceID ||
      std::memcmp(header.pipelineCacheUUID, properties.pipelineCacheUUID, VK_UUID_SIZE) != 0)
    return {};
  return {data.begin(), data.end()};
}

std::vector<std::byte> pack_cache(std::span<const std::byte> data) {
  std::vector<std::byte> out(kPrefixBytes + data.size());
  const std::uint64_t sum = checksum(data);
  std::memcpy(out.data(), kMagic.data(), kMagic.size());
  std::memcpy(out.data() + kMagic.size(), &sum, sizeof sum);
  if (!data.empty()) std::memcpy(out.data() + kPrefixBytes, data.data(), data.size());
  return out;
}

}  // namespace neritic::gpu
