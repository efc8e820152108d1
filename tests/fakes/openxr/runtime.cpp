#include "tests/fakes/openxr/runtime.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <thread>

namespace neritic::fakes {

Runtime& runtime() {
  static Runtime* the = new Runtime;  // outlives every static of the client
  return *the;
}

XrTime Runtime::time(double seconds) const {
  return kEpoch + static_cast<XrTime>(std::llround(seconds * 1e9));
}

Instance* Runtime::instance() {
  for (auto& [handle, object] : objects) {
    if (object->type == XR_OBJECT_TYPE_INSTANCE) return static_cast<Instance*>(object.get());
  }
  return nullptr;
}

void Runtime::destroy(Object& object) {
  for (auto at = objects.begin(); at != objects.end();) {
    if (at->second->parent == &object) {
      destroy(*at->second);
      at = objects.begin();
    } else {
      ++at;
    }
  }
  destroyed[object.handle] = object.type;
  objects.erase(object.handle);
}

void Runtime::fault(const std::string& sentence) {
  faults.push_back(sentence);
  if (!script.report.empty()) std::ofstream(script.report, std::ios::app) << sentence << '\n';
}

Call::Call(Runtime& runtime, const char* function)
    : rt(runtime), function(function), held_(runtime.lock) {}

void Call::note_fault(const std::string& sentence) {
  rt.fault(fmt::format("{}: {}.", function, sentence));
}

void Call::fault(XrResult result, const std::string& sentence) {
  note_fault(sentence);
  throw Refused{result};
}

void Call::fail_by_script() {
  const auto found = rt.script.failures.find(function);
  if (found == rt.script.failures.end()) return;
  ScriptedFailure& failure = found->second;
  if (failure.after > 0) {
    --failure.after;
  } else if (failure.times > 0) {
    --failure.times;
    refuse(failure.result);
  }
}

Instance& Call::instance() {
  Instance* found = rt.instance();
  require(found, XR_ERROR_HANDLE_INVALID, "there is no instance");
  return *found;
}

bool Call::enabled(std::string_view extension) {
  return extension.empty() || instance().extensions.contains(std::string(extension));
}

// Sentences are put together for calls that are wrong alone: a frame has a hundred right ones.
Object& Call::find(std::uint64_t handle, XrObjectType type) {
  const auto right = rt.objects.find(handle);
  if (handle && right != rt.objects.end() && right->second->type == type) return *right->second;
  const std::string wanted = name_of(type);
  require(handle, XR_ERROR_HANDLE_INVALID, "the " + wanted + " is XR_NULL_HANDLE");
  const auto found = rt.objects.find(handle);
  if (found != rt.objects.end()) {
    require(found->second->type == type, XR_ERROR_HANDLE_INVALID,
            fmt::format("a handle of {} was given where {} is wanted", name_of(found->second->type),
                        wanted));
    return *found->second;
  }
  fault(XR_ERROR_HANDLE_INVALID, rt.destroyed.contains(handle)
                                     ? "the " + wanted + " was destroyed, or its parent was"
                                     : "the " + wanted + " was never created");
}

void Call::refuse_lost(const Object& object) {
  for (const Object* at = &object; at; at = at->parent) {
    if (at->type == XR_OBJECT_TYPE_SESSION && static_cast<const Session*>(at)->lost) {
      const Object* top = at->parent;
      if (!static_cast<const Instance*>(top)->lost) refuse(XR_ERROR_SESSION_LOST);
    }
    if (at->type == XR_OBJECT_TYPE_INSTANCE && static_cast<const Instance*>(at)->lost) {
      refuse(XR_ERROR_INSTANCE_LOST);
    }
  }
}

bool Call::wait_for(const std::function<bool()>& condition) {
  return rt.changed.wait_for(held_, std::chrono::seconds(2), condition);
}

void Call::sleep(double seconds) {
  held_.unlock();
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
  held_.lock();
}

void Call::check_structure(const void* structure, XrStructureType type,
                           std::initializer_list<Chained> allowed) {
  auto* base = static_cast<const XrBaseInStructure*>(structure);
  if (base && base->type == type && !base->next) return;
  require(structure, XR_ERROR_VALIDATION_FAILURE,
          "the structure of type " + name_of(type) + " is a null pointer");
  require(base->type == type, XR_ERROR_VALIDATION_FAILURE,
          fmt::format("a structure has the type {}; it must be {}", name_of(base->type),
                      name_of(type)));
  std::set<XrStructureType> seen;
  for (auto* next = base->next; next; next = next->next) {
    const auto rule = std::find_if(allowed.begin(), allowed.end(),
                                   [&](const Chained& one) { return one.type == next->type; });
    if (rule != allowed.end() && enabled(rule->extension) && seen.insert(next->type).second)
      continue;
    require(rule != allowed.end(), XR_ERROR_VALIDATION_FAILURE,
            fmt::format("{} may not stand in the next chain of {}", name_of(next->type),
                        name_of(type)));
    require(enabled(rule->extension), XR_ERROR_VALIDATION_FAILURE,
            fmt::format("{} stands in the next chain of {}, but its extension {} was not enabled",
                        name_of(next->type), name_of(type), rule->extension));
    fault(XR_ERROR_VALIDATION_FAILURE, fmt::format("{} stands twice in the next chain of {}",
                                                   name_of(next->type), name_of(type)));
  }
}

std::int64_t SpentTime::now_ns() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

void Call::check_pose(const XrPosef& pose) {
  const XrQuaternionf& q = pose.orientation;
  const double norm = std::sqrt(double{q.x} * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  if (!(std::abs(norm - 1) <= 0.01))
    fault(XR_ERROR_POSE_INVALID,
          fmt::format("the orientation's quaternion has the length {:.4f}; it must be 1 within 1 %",
                      norm));
  const XrVector3f& p = pose.position;
  require(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z), XR_ERROR_POSE_INVALID,
          "the position is not finite");
}

void Call::check_time(XrTime time) {
  if (time <= 0) fault(XR_ERROR_TIME_INVALID, fmt::format("the time {} is not valid", time));
}

std::string Call::path(XrPath path) {
  Instance& one = instance();
  if (path == XR_NULL_PATH || path > one.paths.size())
    fault(XR_ERROR_PATH_INVALID, fmt::format("the path {} was not made by xrStringToPath", path));
  return one.paths[path - 1];
}

const Table& function_table() {
  static const Table table = [] {
    Table rows;
    add_instance_functions(rows);
    add_view_functions(rows);
    add_vulkan_functions(rows);
    add_session_functions(rows);
    add_frame_functions(rows);
    add_swapchain_functions(rows);
    add_space_functions(rows);
    add_action_functions(rows);
    add_hand_functions(rows);
    return rows;
  }();
  return table;
}

}  // namespace neritic::fakes
