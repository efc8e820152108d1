// Events that reach a client without a call of its own: changes of state, losses, recentring.
#include <fmt/format.h>

#include <sstream>

#include "tests/fakes/openxr/runtime.hpp"

namespace neritic::fakes {
namespace {

void tell(Session& session, XrSessionState state) {
  XrEventDataSessionStateChanged event{};
  event.session = handle_of(session);
  event.state = session.state = state;
  event.time = runtime().now;
  queue(session.instance, event);
}

// The states of a running session from the one begun with to the one in which it is worn.
constexpr XrSessionState kLadder[] = {XR_SESSION_STATE_READY, XR_SESSION_STATE_SYNCHRONIZED,
                                      XR_SESSION_STATE_VISIBLE, XR_SESSION_STATE_FOCUSED};

int rung(XrSessionState state) {
  for (int i = 0; i < 4; ++i) {
    if (kLadder[i] == state) return i;
  }
  return -1;
}

void recenter(Runtime& rt, Instance& instance, std::istringstream& words) {
  double x = 0, z = 0, yaw = 0;
  words >> x >> z >> yaw;
  const Pose before = rt.script.local;
  rt.script.local = {{x, before.position.y, z}, from_degrees(yaw, 0, 0)};
  for (auto& [handle, object] : rt.objects) {
    if (object->type != XR_OBJECT_TYPE_SESSION) continue;
    XrEventDataReferenceSpaceChangePending event{};
    event.session = reinterpret_cast<XrSession>(handle);
    event.referenceSpaceType = XR_REFERENCE_SPACE_TYPE_LOCAL;
    event.changeTime = rt.now;
    event.poseValid = XR_TRUE;
    event.poseInPreviousSpace = to_xr(inverse(before) * rt.script.local);
    queue(instance, event);
  }
}

void change_mask(Session& session) {
  for (std::uint32_t view = 0; view < view_count(session.views); ++view) {
    XrEventDataVisibilityMaskChangedKHR event{};
    event.session = handle_of(session);
    event.viewConfigurationType = session.views;
    event.viewIndex = view;
    queue(session.instance, event);
  }
}

// An event of one session. False: no such thing.
bool perform_on(Session& session, const std::string& what, std::istringstream& words) {
  const std::map<std::string, XrSessionState> states{
      {"focused", XR_SESSION_STATE_FOCUSED},
      {"visible", XR_SESSION_STATE_VISIBLE},
      {"synchronized", XR_SESSION_STATE_SYNCHRONIZED},
      {"stop", XR_SESSION_STATE_STOPPING},
      {"loss_pending", XR_SESSION_STATE_LOSS_PENDING}};
  if (const auto state = states.find(what); state != states.end()) {
    change_state(session, state->second);
    // The system is unplugged: the one of xrGetSystem is not valid any more.
    if (what == "loss_pending")
      session.instance.has_system = session.instance.asked_requirements =
          session.instance.asked_requirements2 = false;
    if (what == "stop") words >> session.wake_after_polls;
  } else if (what == "exit") {
    session.exit_requested = true;
    change_state(session, XR_SESSION_STATE_STOPPING);
  } else if (what == "session_lost") {
    session.lost = true;
  } else if (what == "mask_changed") {
    change_mask(session);
  } else {
    return false;
  }
  return true;
}

}  // namespace

void change_state(Session& session, XrSessionState state) {
  if (state == session.state) return;
  int at = rung(session.state);
  const int to = state == XR_SESSION_STATE_STOPPING ? 1 : rung(state);
  if (at >= 0 && to >= 0 && state != XR_SESSION_STATE_READY) {
    while (at < to) tell(session, kLadder[++at]);
    while (at > to) tell(session, kLadder[--at]);
    if (state != XR_SESSION_STATE_STOPPING) return;
  }
  tell(session, state);
}

std::optional<std::string> perform(Runtime& rt, const std::string& line) {
  std::istringstream words(line);
  std::string what;
  words >> what;
  if (Instance* instance = rt.instance()) {
    if (what == "instance_lost") {
      instance->lost = true;
      return {};
    }
    if (what == "instance_loss_pending") {
      XrEventDataInstanceLossPending event{};
      event.lossTime = rt.now;
      queue(*instance, event);
      return {};
    }
    if (what == "recenter") {
      recenter(rt, *instance, words);
      return {};
    }
    if (what == "main_session") {
      std::string seen;
      words >> seen;
      rt.script.main_visible = seen == "visible";
      XrEventDataMainSessionVisibilityChangedEXTX event{};
      event.visible = rt.script.main_visible;
      queue(*instance, event);
      return {};
    }
    bool done = false;
    for (auto& [handle, object] : rt.objects) {
      if (object->type != XR_OBJECT_TYPE_SESSION) continue;
      std::istringstream rest(line);
      rest >> what;
      done = perform_on(static_cast<Session&>(*object), what, rest) || done;
    }
    if (done) return {};
  }
  return read_script(line, rt.script);
}

void perform_timed(Call& call, std::uint64_t frame) {
  auto& timed = call.rt.script.timed;
  for (std::size_t i = 0; i < timed.size();) {
    if (timed[i].frame != frame) {
      ++i;
      continue;
    }
    const std::string line = timed[i].line;
    timed.erase(timed.begin() + static_cast<std::ptrdiff_t>(i));
    if (const auto wrong = perform(call.rt, line)) call.note_fault("the script's " + *wrong);
  }
}

}  // namespace neritic::fakes
