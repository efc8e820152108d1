// The task of `neritic sonar`, worked out before any image is read: the sensor with its terms, how
// to read the images, and the settings that tell whether an existing result is this run's.
// Plain values; any thread.
#pragma once

#include <nlohmann/json.hpp>

#include "engine/scene/scene.hpp"
#include "sonar/head.hpp"
#include "sonar/offline_input.hpp"
#include "sonar/ping.hpp"
#include "tools/neritic/commands.hpp"

namespace neritic::tools {

struct SonarJob {
  SonarFlags flags;
  scene::Sonar sonar;
  sonar::Head head;  // the one whose axis is the images'; a side-scan's: the side's
  sonar::Gather gather = sonar::Gather::kPublished;
  sonar::OfflineOptions options;
  sonar::PingState state;
  std::vector<float> detection_floor;  // by range row; empty without noise
  nlohmann::json settings;             // all that decides a result but the images

  bool plain() const { return !head.echo; }  // the published plain cosine
};

// kBadInput that names the flag, or the sensor's file and key.
Result<SonarJob> plan_job(const SonarFlags& flags);

// Whether --intrinsics or --camera-pose names a .json or .yaml file, rather than giving numbers.
bool is_camera_file(const std::string& text);

// job.settings; plan_job has set everything else. kBadInput where the intrinsics' file is not
// there.
Result<nlohmann::json> settings_of(const SonarJob& job);

}  // namespace neritic::tools
