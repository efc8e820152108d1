// The images of a scene's sensors as samples: what a recorder, a server or a ROS bridge takes. Each
// is a stream with a name ("rov_camera/color"), a type and a rate. Plain values; any thread.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "engine/scene/scene.hpp"
#include "testbed/samples/sample.hpp"
#include "testbed/sensors/frame_request.hpp"
#include "testbed/sensors/frame_result.hpp"

namespace neritic::testbed {

enum class ImageKind {
  kColor,       // of cameras: RGB, sRGB
  kDepth,       // planar metres along the view axis, +inf where nothing is hit
  kNormals,     // view axes: x right, y up, z backwards; 0 where nothing is hit
  kLabels,      // class
  kInstances,   // instance
  kMotion,      // of cameras: pixels to the sensor's next image; NaN: behind the camera by then
  kEchoes,      // of sonars: rows are range bins, nearest first; columns beams, full port first
  kEchoLabels,  // class of each such bin
};

// encoding: as ROS's sensor_msgs/Image names it. Channels are interleaved, little-endian.
struct ImageType {
  const char* name;
  const char* encoding;
  std::uint32_t pixel_bytes;
};
const ImageType& type_of(ImageKind kind);
// The data that a frame must compute for it, at the host.
Capture capture_of(ImageKind kind);

// An image of a camera, of an eye of a stereo camera ("eyes/left/color"), or of a sonar's head
// ("sidescan/port/echoes"; its arrays are of the view that it gathers from).
struct ImageStream {
  std::string name;
  std::string frame_id;  // name without the type: the frame whose pose the sample says
  bool sonar = false;
  std::size_t sensor = 0;  // into the scene's cameras or sonars
  std::size_t part = 0;    // eye or head
  ImageKind kind = ImageKind::kColor;
  double rate_hz = 0.0;  // of the sensor
};

// Each image that a scene's sensors can give. A stream's id is its place here.
std::vector<ImageStream> image_streams(const scene::Scene& scene);

// Borrows everything from the result of a frame: valid while its sink is called.
struct ImageSample {
  // The source is the simulation. The sequence is the sensor's beat since time 0: one that was left
  // out shows as a gap. Captured: the simulated instant that the image shows; arrived: the host's
  // clock when the image was at the host.
  SampleHeader header;
  const ImageStream* stream = nullptr;
  std::uint32_t width = 0, height = 0;
  std::span<const std::byte> data;    // rows from the top, without padding
  Pose world_from_frame;              // view axes
  const ViewImages* view = nullptr;   // of a camera and a sonar's arrays: intrinsics
  const SonarFrame* sonar = nullptr;  // of a sonar: grid, terms, sound speed
};

// The image of a stream in a frame's result; nothing where it was not computed.
std::optional<ImageSample> image_of(const ImageStream& stream, const scene::Scene& scene,
                                    const FrameResult& result);

// The pixels of such an image, moved out of the result: whoever takes them keeps them without a
// copy. An image_of that was made before still shows them while they live.
using ImagePixels =
    std::variant<std::vector<std::uint8_t>, std::vector<std::uint16_t>, std::vector<float>>;
ImagePixels take_pixels(const ImageStream& stream, const scene::Scene& scene, FrameResult& result);

}  // namespace neritic::testbed
