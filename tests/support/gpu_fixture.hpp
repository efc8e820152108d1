// GpuTest: a test on the shared Vulkan device, with validation and synchronization validation on.
// Any message fails the test; objects still alive at the program's end fail the program. One device
// a process, made by the first test that asks. Reports skipped where the machine has no Vulkan
// device or no validation layer, unless $NERITIC_REQUIRE_DEVICE is 1; any other error is a failure.
// $NERITIC_TEST_DEVICE: which device (name or index) to test on.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <string>

#include "engine/gpu/device.hpp"
#include "engine/gpu/frames.hpp"
#include "tests/support/device_gate.hpp"

namespace neritic::test {

class GpuEnvironment : public ::testing::Environment {
 public:
  // The shared device, or why there is none.
  const Result<std::unique_ptr<gpu::Device>>& device() {
    if (!device_) {
      gpu::DeviceOptions options;
      options.validation = true;
      options.validation_sink = &sink_;
      if (const char* wanted = std::getenv("NERITIC_TEST_DEVICE")) options.device = wanted;
      device_ =
          std::make_unique<Result<std::unique_ptr<gpu::Device>>>(gpu::Device::create(options));
    }
    return *device_;
  }
  void TearDown() override {
    sink_.messages.clear();  // each test has judged its own
    device_.reset();
    for (const std::string& message : sink_.messages)
      ADD_FAILURE() << "at the device's end: " << message;
  }

 private:
  gpu::ValidationLog sink_;  // outlives the device
  std::unique_ptr<Result<std::unique_ptr<gpu::Device>>> device_;
};

// May a test be skipped for this error? Only where nothing is there to test on, and none is
// required.
inline bool may_skip_without_device(const Error& error) {
  if (device_is_required()) return false;
  const bool named =
      std::getenv("NERITIC_TEST_DEVICE") != nullptr;  // a wrong name is no missing device
  return (error.code == ErrorCode::kNoDevice && !named) || !gpu::validation_layer_present();
}

// Registered once a program; GoogleTest owns it.
inline GpuEnvironment* const gpu_environment =
    static_cast<GpuEnvironment*>(::testing::AddGlobalTestEnvironment(new GpuEnvironment));

class GpuTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto& made = gpu_environment->device();
    if (!made.ok() && may_skip_without_device(made.error())) GTEST_SKIP() << made.error().message;
    ASSERT_TRUE(made.ok()) << made.error().message;
    device_ = made.value().get();
    device_->clear_validation_log();
  }
  void TearDown() override {
    if (!device_) return;
    device_->wait_idle();
    for (const std::string& message : device_->validation_log().messages) ADD_FAILURE() << message;
    device_->clear_validation_log();
  }
  gpu::Device& device() { return *device_; }

 private:
  gpu::Device* device_ = nullptr;
};

// The value of a Result, or a failed test and the end of it.
#define NERITIC_ASSERT_OK(declaration, expression) \
  NERITIC_ASSERT_OK_INNER(declaration, expression, NERITIC_CONCAT(asserted_, __LINE__))
#define NERITIC_ASSERT_OK_INNER(declaration, expression, name) \
  auto name = (expression);                                    \
  ASSERT_TRUE(name.ok()) << name.error().message;              \
  declaration = std::move(name).value()
#define NERITIC_ASSERT_STATUS(expression)                                 \
  do {                                                                    \
    const ::neritic::Status asserted_status = (expression);               \
    ASSERT_TRUE(asserted_status.ok()) << asserted_status.error().message; \
  } while (false)

}  // namespace neritic::test
