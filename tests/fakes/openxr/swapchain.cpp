// Swapchains: formats, images, and the order acquire, wait, release.
#include <fmt/format.h>

#include <algorithm>

#include "tests/fakes/openxr/runtime.hpp"

namespace neritic::fakes {

Swapchain::~Swapchain() {
  if (session.gpu) destroy_images(*session.gpu, images);
}

namespace {

XrResult enumerate_formats(Call& call, XrSession handle, std::uint32_t capacity,
                           std::uint32_t* count, std::int64_t* formats) {
  call.get<Session>(handle);
  call.fill(capacity, count, formats, call.rt.script.formats);
  return XR_SUCCESS;
}

void check_create(Call& call, const XrSwapchainCreateInfo& info) {
  const Script& script = call.rt.script;
  const auto& formats = script.formats;
  call.require(std::find(formats.begin(), formats.end(), info.format) != formats.end(),
               XR_ERROR_SWAPCHAIN_FORMAT_UNSUPPORTED,
               fmt::format("the format {} is not among xrEnumerateSwapchainFormats", info.format));
  const auto check = [&](bool fine, const std::string& rule) {
    call.require(fine, XR_ERROR_VALIDATION_FAILURE, rule);
  };
  check(info.width > 0 && info.height > 0 && info.width <= script.max_size &&
            info.height <= script.max_size,
        fmt::format("the size {} x {} is not within 1 and {}", info.width, info.height,
                    script.max_size));
  check(info.sampleCount == 1,
        fmt::format("sampleCount is {}; maxSwapchainSampleCount is 1", info.sampleCount));
  check(info.faceCount == 1,
        fmt::format("faceCount is {}; cubes are not supported", info.faceCount));
  check(info.mipCount >= 1, "mipCount is 0");
  check(info.arraySize >= 1 && info.arraySize <= script.max_array,
        fmt::format("arraySize is {}; accepted: 1 to {}", info.arraySize, script.max_array));
  check(info.usageFlags != 0, "usageFlags is 0");
  check(!is_depth(info.format) || !(info.usageFlags & XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT),
        "a depth format has the usage of a colour attachment");
  check(
      is_depth(info.format) || !(info.usageFlags & XR_SWAPCHAIN_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT),
      "a colour format has the usage of a depth attachment");
  if (info.createFlags & XR_SWAPCHAIN_CREATE_PROTECTED_CONTENT_BIT) {
    call.refuse(XR_ERROR_FEATURE_UNSUPPORTED);
  }
}

XrResult create_swapchain(Call& call, XrSession handle, const XrSwapchainCreateInfo* create,
                          XrSwapchain* made) {
  Session& session = call.get<Session>(handle);
  const auto& info = call.in(create);
  call.not_null(made, "the swapchain");
  check_create(call, info);
  const bool still = info.createFlags & XR_SWAPCHAIN_CREATE_STATIC_IMAGE_BIT;
  auto images = make_images(*session.gpu, info, still ? 1 : call.rt.script.swapchain_length);
  if (images.empty()) return XR_ERROR_OUT_OF_MEMORY;
  Swapchain& swapchain = call.add<Swapchain>(&session);
  swapchain.info = info;
  swapchain.info.next = nullptr;
  swapchain.images = std::move(images);
  swapchain.uses.assign(swapchain.images.size(), ImageUse::kFree);
  *made = handle_of(swapchain);
  return XR_SUCCESS;
}

XrResult destroy_swapchain(Call& call, XrSwapchain handle) {
  call.rt.destroy(call.get_to_destroy<Swapchain>(handle));
  return XR_SUCCESS;
}

XrResult enumerate_images(Call& call, XrSwapchain handle, std::uint32_t capacity,
                          std::uint32_t* count, XrSwapchainImageBaseHeader* headers) {
  const Swapchain& swapchain = call.get<Swapchain>(handle);
  const auto length = static_cast<std::uint32_t>(swapchain.images.size());
  *call.not_null(count, "the count") = length;
  if (capacity == 0) return XR_SUCCESS;
  call.not_null(headers, "the array");
  if (capacity < length) return XR_ERROR_SIZE_INSUFFICIENT;
  auto* images = reinterpret_cast<XrSwapchainImageVulkanKHR*>(headers);
  for (std::uint32_t i = 0; i < length; ++i) call.out(images + i).image = swapchain.images[i].image;
  return XR_SUCCESS;
}

XrResult acquire(Call& call, XrSwapchain handle, const XrSwapchainImageAcquireInfo* info,
                 std::uint32_t* index) {
  Swapchain& swapchain = call.get<Swapchain>(handle);
  if (info) call.in(info);
  call.not_null(index, "the index");
  const bool still = swapchain.info.createFlags & XR_SWAPCHAIN_CREATE_STATIC_IMAGE_BIT;
  call.require(!still || !swapchain.ever_acquired, XR_ERROR_CALL_ORDER_INVALID,
               "the image of a static swapchain may be acquired once");
  call.require(swapchain.uses[swapchain.next] == ImageUse::kFree, XR_ERROR_CALL_ORDER_INVALID,
               "all images are acquired; one must be released first");
  *index = swapchain.next;
  swapchain.uses[*index] = ImageUse::kAcquired;
  swapchain.acquired.push_back(*index);
  swapchain.next = (swapchain.next + 1) % static_cast<std::uint32_t>(swapchain.images.size());
  swapchain.ever_acquired = true;
  return XR_SUCCESS;
}

XrResult wait_image(Call& call, XrSwapchain handle, const XrSwapchainImageWaitInfo* wait) {
  Swapchain& swapchain = call.get<Swapchain>(handle);
  const auto& info = call.in(wait);
  call.require(!swapchain.acquired.empty(), XR_ERROR_CALL_ORDER_INVALID,
               "no image is acquired; xrAcquireSwapchainImage comes first");
  ImageUse& use = swapchain.uses[swapchain.acquired.front()];
  call.require(use == ImageUse::kAcquired, XR_ERROR_CALL_ORDER_INVALID,
               "an image was waited for already; it must be released before the next wait");
  int& timeouts = call.rt.script.image_timeouts;
  if (timeouts > 0 && info.timeout != XR_INFINITE_DURATION) {
    --timeouts;
    return XR_TIMEOUT_EXPIRED;
  }
  use = ImageUse::kWaited;
  return XR_SUCCESS;
}

XrResult release(Call& call, XrSwapchain handle, const XrSwapchainImageReleaseInfo* info) {
  Swapchain& swapchain = call.get<Swapchain>(handle);
  if (info) call.in(info);
  call.require(!swapchain.acquired.empty(), XR_ERROR_CALL_ORDER_INVALID,
               "no image is acquired; xrAcquireSwapchainImage and xrWaitSwapchainImage come first");
  const std::uint32_t index = swapchain.acquired.front();
  call.require(swapchain.uses[index] == ImageUse::kWaited, XR_ERROR_CALL_ORDER_INVALID,
               "the image was not waited for; xrWaitSwapchainImage comes first");
  if (!in_client_layout(*swapchain.session.gpu, swapchain.info, swapchain.images[index].image)) {
    call.note_fault(
        fmt::format("the image is not in VK_IMAGE_LAYOUT_{}_ATTACHMENT_OPTIMAL, in which "
                    "it must be released",
                    is_depth(swapchain.info.format) ? "DEPTH_STENCIL" : "COLOR"));
  }
  swapchain.acquired.pop_front();
  swapchain.uses[index] = ImageUse::kFree;
  swapchain.released = static_cast<int>(index);
  return XR_SUCCESS;
}

}  // namespace

void add_swapchain_functions(Table& table) {
  table.insert(table.end(), {NERITIC_XR_ROW(xrEnumerateSwapchainFormats, enumerate_formats, ""),
                             NERITIC_XR_ROW(xrCreateSwapchain, create_swapchain, ""),
                             NERITIC_XR_ROW(xrDestroySwapchain, destroy_swapchain, ""),
                             NERITIC_XR_ROW(xrEnumerateSwapchainImages, enumerate_images, ""),
                             NERITIC_XR_ROW(xrAcquireSwapchainImage, acquire, ""),
                             NERITIC_XR_ROW(xrWaitSwapchainImage, wait_image, ""),
                             NERITIC_XR_ROW(xrReleaseSwapchainImage, release, "")});
}

}  // namespace neritic::fakes
