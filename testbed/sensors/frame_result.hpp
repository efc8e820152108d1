// A frame's images and echoes at the host, in the conventions of the file contract. Plain values;
// any thread.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/core/image.hpp"
#include "engine/core/intrinsics.hpp"
#include "engine/gpu/frames.hpp"
#include "engine/scene/motion.hpp"
#include "sonar/beam_grid.hpp"
#include "sonar/label_energy.hpp"
#include "sonar/quality.hpp"
#include "sonar/reference.hpp"
#include "testbed/sensors/instance_boxes.hpp"

namespace neritic::testbed {

// One view's images. Those that were not asked for are empty.
struct ViewImages {
  Pose world_from_view;
  Intrinsics intrinsics;
  double near_m = 0.0;
  std::uint32_t width = 0, height = 0;
  ImageF32 depth;    // planar metres, +inf where nothing is hit
  ImageF32 normals;  // 3 channels, view axes; 0 where nothing is hit
  ImageU16 labels;   // class
  ImageU16 instances;
  ImageU8 color;    // RGB, sRGB
  ImageF32 motion;  // 2 channels, pixels to the next frame
  ImageF32 linear;  // RGB, exposed radiance before the tone curve: 1 is white in the scene's light
  ImageU16 raw;     // counts of the image sensor behind its colour filters
  std::optional<scene::Lens> lens;  // then a pixel is intrinsics * through_lens(point)
  std::optional<scene::ImageSensor> sensor;
  std::vector<InstanceBox> boxes;
};

// A camera's images, or a view set's of the request.
struct CameraFrame {
  std::string name;
  std::vector<ViewImages> eyes;  // a camera's: one, or left and right
};

// The echoes of one head of a sonar (a side-scan has two heads).
struct SonarFrame {
  std::string name, head;  // head: "" or "port", "starboard"
  scene::SonarKind kind = scene::SonarKind::kImaging;
  std::string gather;
  sonar::BeamGrid grid;  // of the image: azimuth bins are beams
  // Intensity: the plain cosine's mean over elevation, or, with level, the power that leaves the
  // receiver (times its gains), 1 being 1 uPa^2. Empty where no echoes were asked for.
  sonar::SonarImage image;
  bool heard() const { return !image.intensity.empty(); }
  bool level = false;
  scene::SonarTerms terms;
  std::optional<sonar::LabelImage> label_energy;  // where labels by energy are named
  Pose world_from_sonar, world_from_head;
  double heading_rad = 0.0;  // of a mechanical scanner's beam, sonar axes, positive to starboard
  double sound_speed_m_s = 0.0;               // that stands for the time of an echo in its range
  std::optional<double> absorption_db_per_m;  // with terms
  std::vector<float> noise_power;  // mean of the noise in each range row; empty: none is named
  const sonar::QualityLevel* quality = nullptr;  // the level that sets its sampling, if any
  double max_error = 0.0;                        // the error that chose the level; 0: its name did
  bool quality_chosen = false;                   // the scene names none
  double fixed_scale = 1.0;
  std::uint32_t gbuffer_width = 1, gbuffer_height = 1;  // of one sector's arrays
  // The view that was gathered from: its size, and by how many pixels each of its rows is shifted
  // against the next (sonar::leaning_view); the published gather shifts none.
  std::uint32_t sampled_width = 1, sampled_height = 1;
  double shift_px = 0.0;
  double pixels_per_cell = 1.0;          // asked for, linear
  glm::dvec2 pixels_per_cell_used{1.0};  // azimuth, elevation; less where the device's images end
  // Factor of the incidence by instance label; empty: all are 1, or a level has its own.
  std::vector<float> reflectivity;
  std::vector<ViewImages> sectors;  // geometry only; one for apertures up to 100 degrees
};

struct FrameResult {
  std::uint32_t frame = 0;  // the request's
  double time_s = 0.0;      // the request's
  std::vector<CameraFrame> cameras;
  std::vector<CameraFrame> views;  // the request's view sets
  std::vector<SonarFrame> sonars;
  std::vector<scene::MotionAt> poses;  // of every participant (participants.hpp), if asked for
  std::vector<gpu::PassTime> passes;
  double frame_ms = 0.0;  // from declare to the result
};

}  // namespace neritic::testbed
