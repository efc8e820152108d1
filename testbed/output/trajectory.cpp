#include "testbed/output/trajectory.hpp"

#include <set>

#include "engine/core/check.hpp"
#include "engine/core/files.hpp"

namespace neritic::testbed {
namespace {

constexpr const char* kColumns =
    "frame,time_s,name,kind,x_m,y_m,z_m,qx,qy,qz,qw,vx_m_s,vy_m_s,vz_m_s,wx_rad_s,wy_rad_s,"
    "wz_rad_s,known\n";

std::string numbers(const Vec3& v, char before) {
  return fmt::format("{0}{1:.10g}{0}{2:.10g}{0}{3:.10g}", before, v.x, v.y, v.z);
}

std::string pose_numbers(const Pose& pose, char before) {
  const Quat& q = pose.rotation;
  return numbers(pose.position_m, before) + numbers({q.x, q.y, q.z}, before) +
         fmt::format("{}{:.10g}", before, q.w);
}

}  // namespace

TrajectoryFiles::TrajectoryFiles(std::vector<Participant> participants,
                                 const std::filesystem::path& out)
    : participants_(std::move(participants)),
      folder_(out / "trajectory"),
      csv_(out / "trajectory.csv") {
  // Names of sensors and of objects are unique, but a camera may have its vehicle's name.
  std::set<std::string> names;
  for (const Participant& one : participants_) {
    const bool free = names.insert(one.name).second;
    tum_.emplace_back(folder_ / ((free ? one.name : one.name + "_" + one.kind) + ".txt"));
  }
}

Status TrajectoryFiles::add(const FrameResult& frame) {
  NERITIC_CHECK(frame.poses.size() == participants_.size(), "{} poses of {} participants",
                frame.poses.size(), participants_.size());
  if (!std::exchange(begun_, true)) {
    NERITIC_TRY_STATUS(make_folder(folder_));
    NERITIC_TRY_STATUS(csv_.append(kColumns));
  }
  for (std::size_t i = 0; i < participants_.size(); ++i) {
    const Motion& motion = frame.poses[i].motion;
    NERITIC_TRY_STATUS(csv_.append(fmt::format(
        "{},{:.9f},{},{}{}{}{},{}\n", frame.frame, frame.time_s, participants_[i].name,
        participants_[i].kind, pose_numbers(motion.pose, ','), numbers(motion.velocity_m_s, ','),
        numbers(motion.angular_velocity_rad_s, ','), name_of(frame.poses[i].known))));
    NERITIC_TRY_STATUS(
        tum_[i].append(fmt::format("{:.9f}{}\n", frame.time_s, pose_numbers(motion.pose, ' '))));
  }
  return {};
}

Status TrajectoryFiles::finish() {
  if (!begun_) return {};
  for (GrowingFile& file : tum_) NERITIC_TRY_STATUS(file.finish());
  return csv_.finish();
}

}  // namespace neritic::testbed
