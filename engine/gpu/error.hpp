// Inside engine/gpu only: turns a VkResult into a returned Error. Any thread.
#pragma once

#include "engine/core/result.hpp"
#include "engine/gpu/device.hpp"

// NERITIC_TRY_VK("vkCreateBuffer (name)", vkCreateBuffer(...)): returns the error unless
// VK_SUCCESS.
#define NERITIC_TRY_VK(what, call)                                  \
  if (const VkResult NERITIC_CONCAT(vk_result_, __LINE__) = (call); \
      NERITIC_CONCAT(vk_result_, __LINE__) != VK_SUCCESS)           \
  return ::neritic::gpu::vulkan_error(NERITIC_CONCAT(vk_result_, __LINE__), what)
