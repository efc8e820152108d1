#include "engine/recording/ros_types.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <vector>

#include "engine/core/check.hpp"

namespace neritic::recording {
namespace {

// By the name that other messages use.
const std::map<std::string, std::string, std::less<>>& definitions() {
  static const std::map<std::string, std::string, std::less<>> all{
      {"builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"},
      {"std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n"},
      {"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"},
      {"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"},
      {"geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"},
      {"geometry_msgs/Pose",
       "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n"},
      {"geometry_msgs/PoseWithCovariance", "geometry_msgs/Pose pose\nfloat64[36] covariance\n"},
      {"geometry_msgs/Twist", "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n"},
      {"geometry_msgs/TwistWithCovariance", "geometry_msgs/Twist twist\nfloat64[36] covariance\n"},
      {"geometry_msgs/PoseStamped", "std_msgs/Header header\ngeometry_msgs/Pose pose\n"},
      {"geometry_msgs/PointStamped", "std_msgs/Header header\ngeometry_msgs/Point point\n"},
      {"nav_msgs/Odometry",
       "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
       "geometry_msgs/TwistWithCovariance twist\n"},
      {"sensor_msgs/Imu",
       "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\n"
       "float64[9] orientation_covariance\ngeometry_msgs/Vector3 angular_velocity\n"
       "float64[9] angular_velocity_covariance\ngeometry_msgs/Vector3 linear_acceleration\n"
       "float64[9] linear_acceleration_covariance\n"},
      {"sensor_msgs/FluidPressure",
       "std_msgs/Header header\nfloat64 fluid_pressure\nfloat64 variance\n"},
      {"sensor_msgs/BatteryState",
       "std_msgs/Header header\nfloat32 voltage\nfloat32 temperature\nfloat32 current\n"
       "float32 charge\nfloat32 capacity\nfloat32 design_capacity\nfloat32 percentage\n"
       "uint8 power_supply_status\nuint8 power_supply_health\nuint8 power_supply_technology\n"
       "bool present\nfloat32[] cell_voltage\nfloat32[] cell_temperature\nstring location\n"
       "string serial_number\n"},
      {"sensor_msgs/Range",
       "uint8 ULTRASOUND=0\nuint8 INFRARED=1\nstd_msgs/Header header\nuint8 radiation_type\n"
       "float32 field_of_view\nfloat32 min_range\nfloat32 max_range\nfloat32 range\n"},
      // Sound of a microphone: samples from -1 to 1.
      {"neritic_msgs/Audio", "std_msgs/Header header\nfloat64 rate_hz\nfloat32[] samples\n"},
      // A strap's ECG: microvolts.
      {"neritic_msgs/Ecg", "std_msgs/Header header\nfloat64 rate_hz\nfloat32[] samples\n"},
      {"sensor_msgs/Image",
       "std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\n"
       "uint8 is_bigendian\nuint32 step\nuint8[] data\n"},
      {"marine_acoustic_msgs/Dvl",
       "uint8 DVL_MODE_BOTTOM=1\nuint8 DVL_MODE_WATER=2\nuint8 DVL_TYPE_PISTON=0\n"
       "uint8 DVL_TYPE_PHASED_ARRAY=1\nstd_msgs/Header header\nuint8 velocity_mode\n"
       "uint8 dvl_type\ngeometry_msgs/Vector3 velocity\nfloat64[9] velocity_covar\n"
       "float64 altitude\nfloat64 course_gnd\nfloat64 speed_gnd\nuint8 num_good_beams\n"
       "float32 sound_speed\nbool beam_ranges_valid\nbool beam_velocities_valid\n"
       "geometry_msgs/Vector3[4] beam_unit_vec\nfloat64[4] range\nfloat32[4] range_covar\n"
       "float32[4] beam_quality\nfloat32[4] beam_velocity\nfloat32[4] beam_velocity_covar\n"},
      {"marine_acoustic_msgs/PingInfo",
       "float64 frequency\nfloat64 sound_speed\nfloat32[] tx_beamwidths\n"
       "float32[] rx_beamwidths\n"},
      {"marine_acoustic_msgs/SonarImageData",
       "uint8 DTYPE_UINT8=0\nuint8 DTYPE_INT8=1\nuint8 DTYPE_UINT16=2\nuint8 DTYPE_INT16=3\n"
       "uint8 DTYPE_UINT32=4\nuint8 DTYPE_INT32=5\nuint8 DTYPE_UINT64=6\nuint8 DTYPE_INT64=7\n"
       "uint8 DTYPE_FLOAT32=8\nuint8 DTYPE_FLOAT64=9\nbool is_bigendian\nuint32 dtype\n"
       "uint32 beam_count\nuint8[] data\n"},
      {"marine_acoustic_msgs/ProjectedSonarImage",
       "std_msgs/Header header\nmarine_acoustic_msgs/PingInfo ping_info\n"
       "geometry_msgs/Vector3[] beam_directions\nfloat32[] ranges\n"
       "marine_acoustic_msgs/SonarImageData image\n"},
  };
  return all;
}

// The types with a package that the lines use, in their order, each once.
void add_used(std::string_view lines, std::vector<std::string>& used) {
  while (!lines.empty()) {
    const std::size_t end = std::min(lines.find('\n'), lines.size());
    const std::string_view line = lines.substr(0, end);
    lines.remove_prefix(std::min(end + 1, lines.size()));
    const std::string_view type = line.substr(0, line.find_first_of(" ["));
    if (type.starts_with('#') || type.find('/') == type.npos) continue;
    if (std::ranges::find(used, type) == used.end()) used.emplace_back(type);
  }
}

}  // namespace

McapSchema own_schema(std::string_view type, std::string_view lines) {
  std::vector<std::string> used;
  add_used(lines, used);
  std::string data(lines);
  for (std::size_t i = 0; i < used.size(); ++i) {
    const auto at = definitions().find(used[i]);
    NERITIC_CHECK(at != definitions().end(), "no definition of {}", used[i]);
    data += fmt::format("{:=<80}\nMSG: {}\n{}", "", used[i], at->second);
    add_used(at->second, used);
  }
  return {std::string(type), "ros2msg", data};
}

McapSchema ros_schema(std::string_view type) {
  std::string name(type);
  if (const auto msg = name.find("/msg/"); msg != name.npos) name.erase(msg, 4);
  const auto at = definitions().find(name);
  NERITIC_CHECK(at != definitions().end(), "no definition of {}", type);
  return own_schema(type, at->second);
}

}  // namespace neritic::recording
