// The state of the fake runtime, one a process, as of every OpenXR runtime: its script, simulated
// time, objects and the faults of the client. Call opens each function of the interface: it takes
// the lock and knows the function's name, which begins the sentence of each fault.
#pragma once

#include <atomic>
#include <cmath>
#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "tests/fakes/openxr/objects.hpp"
#include "tests/fakes/openxr/script.hpp"

namespace neritic::fakes {

// XrTime of the script's second 0: not 0, so that a client that mixes clocks is seen.
inline constexpr XrTime kEpoch = 10'000'000'000;
inline constexpr XrSystemId kSystem = 0x5EA;

struct Runtime {
  std::recursive_mutex lock;
  std::condition_variable_any changed;
  Script script;
  XrTime now = kEpoch;
  std::int64_t host_epoch_ns = 0;  // CLOCK_MONOTONIC at kEpoch
  std::vector<std::string> faults;
  std::vector<std::string> log;  // one line for each frame that ended
  std::map<std::uint64_t, std::unique_ptr<Object>> objects;
  std::map<std::uint64_t, XrObjectType> destroyed;
  // All that xrCreateVulkanInstanceKHR and xrCreateVulkanDeviceKHR made in this process, newest
  // last: they outlive the instance of OpenXR.
  std::vector<VulkanObjects> made_vulkan;
  std::uint64_t next_handle = 0x5EA0000000000001;

  double seconds(XrTime time) const { return static_cast<double>(time - kEpoch) * 1e-9; }
  XrTime time(double seconds) const;
  Instance* instance();          // the one there is, or null
  void destroy(Object& object);  // and its children
  void fault(const std::string& sentence);
};
Runtime& runtime();

// Ends a call with a result that is not success.
struct Refused {
  XrResult result;
};

// A structure that may stand in a next chain, and the extension that it needs ("" for none).
struct Chained {
  XrStructureType type;
  std::string_view extension = {};
};

class Call {
 public:
  Call(Runtime& runtime, const char* function);
  Runtime& rt;
  const char* const function;

  // The client broke a rule: records "FUNCTION: SENTENCE" and ends the call.
  [[noreturn]] void fault(XrResult result, const std::string& sentence);
  // Only records; the call goes on.
  void note_fault(const std::string& sentence);
  // Ends the call where the script's `fails` says so.
  void fail_by_script();
  // Ends the call by what the specification lets happen to a correct client.
  [[noreturn]] void refuse(XrResult result) { throw Refused{result}; }
  void require(bool fine, XrResult result, const std::string& sentence) {
    if (!fine) fault(result, sentence);
  }

  // The live object of a handle; a lost instance or session ends the call.
  template <class T>
  T& get(typename T::Handle handle) {
    T& object = get_to_destroy<T>(handle);
    refuse_lost(object);
    return object;
  }
  template <class T>
  T& get_to_destroy(typename T::Handle handle) {
    return static_cast<T&>(find(reinterpret_cast<std::uint64_t>(handle), T::kObject));
  }
  template <class T, class... Arguments>
  T& add(Arguments&&... arguments) {
    auto made = std::make_unique<T>(std::forward<Arguments>(arguments)...);
    T& object = *made;
    object.handle = rt.next_handle++;
    rt.objects[object.handle] = std::move(made);
    return object;
  }

  // A structure that the client fills in: not null, its type right, its chain of allowed ones.
  template <class T>
  const T& in(const T* structure, std::initializer_list<Chained> allowed = {}) {
    check_structure(structure, kType<T>, allowed);
    return *structure;
  }
  // One that the runtime fills in; the client sets type and next.
  template <class T>
  T& out(T* structure, std::initializer_list<Chained> allowed = {}) {
    check_structure(structure, kType<T>, allowed);
    return *structure;
  }
  template <class T>
  T* not_null(T* pointer, const char* name) {
    if (!pointer) fault(XR_ERROR_VALIDATION_FAILURE, std::string(name) + " is a null pointer");
    return pointer;
  }
  // The two-call way of an array: capacity 0 asks for the count.
  template <class T, class Source>
  void fill(std::uint32_t capacity, std::uint32_t* count, T* to, const Source& from) {
    *not_null(count, "the count") = static_cast<std::uint32_t>(from.size());
    if (capacity == 0) return;
    not_null(to, "the array, though its capacity is not 0,");
    if (capacity < from.size()) refuse(XR_ERROR_SIZE_INSUFFICIENT);
    for (const auto& value : from) *to++ = value;
  }

  Instance& instance();  // the one there is
  std::string path(XrPath path);
  bool enabled(std::string_view extension);
  // The structure of a type in a chain, or null.
  template <class T>
  static T* chained(const void* next) {
    for (auto* at = static_cast<const XrBaseInStructure*>(next); at; at = at->next) {
      if (at->type == kType<T>) return reinterpret_cast<T*>(const_cast<XrBaseInStructure*>(at));
    }
    return nullptr;
  }
  void check_structure(const void* structure, XrStructureType type,
                       std::initializer_list<Chained> allowed);
  // Lets other threads in until the condition holds. False: it did not within two seconds.
  bool wait_for(const std::function<bool()>& condition);
  // Lets other threads in for that long.
  void sleep(double seconds);
  void check_pose(const XrPosef& pose);
  void check_time(XrTime time);

 private:
  Object& find(std::uint64_t handle, XrObjectType type);
  void refuse_lost(const Object& object);
  std::unique_lock<std::recursive_mutex> held_;
};

template <class T>
typename T::Handle handle_of(const T& object) {
  return reinterpret_cast<typename T::Handle>(object.handle);
}

// A row of the table of functions: the name, the extension it comes with ("" for core), and a
// function with OpenXR's own signature around one that takes a Call first and may throw Refused.
struct Row {
  const char* name;
  const char* extension;
  PFN_xrVoidFunction function;
};
using Table = std::vector<Row>;

template <auto kFunction>
inline const char* function_name = "";

// The processor's time of the client's threads within the runtime's functions, once a test wants to
// know it: reading a thread's clock takes as long as a short function does.
class SpentTime {
 public:
  SpentTime() : begun_ns_(counted ? now_ns() : 0) {}
  ~SpentTime() {
    if (counted) spent_ns += now_ns() - begun_ns_;
  }
  static inline std::atomic<bool> counted = false;
  static inline std::atomic<std::int64_t> spent_ns = 0;

 private:
  static std::int64_t now_ns();  // of the calling thread
  const std::int64_t begun_ns_;
};

template <auto kFunction, class... Arguments>
XrResult XRAPI_CALL entry(Arguments... arguments) {
  const SpentTime spent;
  try {
    Call call(runtime(), function_name<kFunction>);
    call.fail_by_script();
    return kFunction(call, arguments...);
  } catch (const Refused& refused) {
    return refused.result;
  }
}

template <auto kFunction, class... Arguments>
Row row(const char* name, const char* extension, XrResult (*)(Arguments...)) {
  function_name<kFunction> = name;
  return {name, extension, reinterpret_cast<PFN_xrVoidFunction>(entry<kFunction, Arguments...>)};
}
// NERITIC_XR_ROW(xrCreateInstance, create_instance, "")
#define NERITIC_XR_ROW(name, function, extension) \
  row<function>(#name, extension, static_cast<PFN_##name>(nullptr))

// The functions that each file adds to the table.
void add_instance_functions(Table& table);
void add_view_functions(Table& table);
void add_vulkan_functions(Table& table);
void add_session_functions(Table& table);
void add_frame_functions(Table& table);
void add_swapchain_functions(Table& table);
void add_space_functions(Table& table);
void add_action_functions(Table& table);
void add_hand_functions(Table& table);
const Table& function_table();

// The extensions that the script's headset offers.
std::vector<XrExtensionProperties> offered_extensions(const Script& script);

// Queues an event of any structure.
template <class T>
void queue(Instance& instance, T event) {
  event.type = kType<T>;
  event.next = nullptr;
  XrEventDataBuffer buffer{};
  static_assert(sizeof(T) <= sizeof(buffer));
  __builtin_memcpy(static_cast<void*>(&buffer), &event, sizeof(event));
  instance.events.push_back(buffer);
}
// Tells the client, through each state between.
void change_state(Session& session, XrSessionState state);

// One line of what happens ("exit", "session_lost", ...: README.md) or of the script.
// A sentence: the line is not understood.
std::optional<std::string> perform(Runtime& runtime, const std::string& line);

// The pose of a space at a time in the stage's frame, with the flags of validity and tracking.
struct Located {
  Pose pose;
  bool oriented = true, positioned = true, tracked = true;
  XrTime sample_time = 0;  // of a gaze
};
Located locate(Runtime& runtime, const Space& space, XrTime time);
// The position of a pose in which it is not valid: a client must not read it.
inline constexpr XrVector3f kUnknown{NAN, NAN, NAN};
Located locate_view_space(Runtime& runtime, XrTime time);
Located locate_action(Runtime& runtime, const Space& space, XrTime time);
// At the last sample of the eye tracker that there is for the time: it predicts nothing.
Located locate_gaze(Runtime& runtime, XrTime time);

// The views of a configuration: each one's pose in the head's frame and its frustum (radians).
std::vector<XrView> views_in_head(const Script& script, XrViewConfigurationType type,
                                  std::optional<glm::dquat> gaze_in_head);
std::uint32_t view_count(XrViewConfigurationType type);

// The simulated time of the monotonic clock.
XrTime real_now(const Runtime& runtime);
// Events of a frame, before it is predicted: the script's timed lines.
void perform_timed(Call& call, std::uint64_t frame);

// Checks the layers of a frame; draws them where the script asks for it.
void check_layers(Call& call, Session& session, const XrFrameEndInfo& info);
void compose(Call& call, Session& session, const XrFrameEndInfo& info);

}  // namespace neritic::fakes
