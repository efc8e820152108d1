// Interaction profiles: which paths of which controllers exist, and what kind of input each is
// (OpenXR specification 1.0, "Interaction Profile Paths" and XR_EXT_eye_gaze_interaction).
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace neritic::fakes {

enum class InputKind { kNone, kBoolean, kFloat, kVector2, kPose, kHaptic };

struct Profile {
  std::string_view path, extension;
  std::vector<std::string_view> tops;               // "/user/hand/left", ...
  std::vector<std::string_view> both, left, right;  // components of every top, or of one hand
};

// Null: no such profile.
const Profile* find_profile(std::string_view path);
// "/user/hand/left" of a longer path; "" if it begins with no top-level user path.
std::string top_of(std::string_view path);
bool is_top(std::string_view path);

// A path of a binding, its input resolved to a full component ("input/trigger" to
// "input/trigger/value").
struct Resolved {
  InputKind kind = InputKind::kNone;  // kNone: the profile has no such path
  std::string path;
};
Resolved resolve(const Profile& profile, const std::string& path);

}  // namespace neritic::fakes
