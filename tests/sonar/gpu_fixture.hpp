// One device with validation for all GPU tests of this program; any message fails the test.
#pragma once

#include <gtest/gtest.h>

#include "engine/gpu/device.hpp"
#include "sonar/image_gather.hpp"

namespace neritic::test {

class GpuFixture : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    gpu::DeviceOptions options;
    options.validation = true;
    auto made = gpu::Device::create(options);
    if (made.ok())
      device_ = std::move(*made).release();
    else
      why_not_ = new std::string(made.error().message);
  }
  static void TearDownTestSuite() {
    delete device_;
    delete why_not_;
    device_ = nullptr;
    why_not_ = nullptr;
  }
  void SetUp() override {
    if (device_ == nullptr) GTEST_SKIP() << *why_not_;
    device_->clear_validation_log();
  }
  void TearDown() override {
    if (device_ == nullptr) return;
    for (const std::string& message : device_->validation_log().messages) ADD_FAILURE() << message;
  }
  gpu::Device& device() { return *device_; }

  sonar::SonarImage run(const sonar::BeamGrid& grid, std::span<const sonar::SonarInput> inputs,
                        sonar::Gather gather) {
    auto made = sonar::ImageGather::create(*device_, grid, inputs, gather);
    if (!made.ok()) {
      ADD_FAILURE() << made.error().message;
      return {grid.bins.range, grid.bins.azimuth,
              std::vector<float>(std::size_t{grid.bins.range} * grid.bins.azimuth),
              std::vector<std::uint16_t>(std::size_t{grid.bins.range} * grid.bins.azimuth)};
    }
    auto image = (*made)->run();
    EXPECT_TRUE(image.ok()) << (image.ok() ? "" : image.error().message);
    return std::move(*image);
  }

 private:
  static inline gpu::Device* device_ = nullptr;
  static inline std::string* why_not_ = nullptr;
};

}  // namespace neritic::test
