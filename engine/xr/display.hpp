// The interface between the program and the device that shows its frames: a desktop window, an
// offscreen image, a headset. A frame is begin_frame, then, if the verdict is kDraw, declare
// and the submission with sync(), then end_frame on every path. Rendering thread.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "engine/core/clock.hpp"
#include "engine/core/math.hpp"
#include "engine/core/result.hpp"
#include "engine/gpu/frames.hpp"
#include "engine/graph/frame_graph.hpp"
#include "engine/xr/actions.hpp"

namespace neritic::xr {

// Corners of a view's hidden triangles, at most; runtimes give some hundred.
inline constexpr std::size_t kMostHiddenCorners = 6000;

struct View {
  Pose head_from_view;
  FrustumTangents tangents;  // asymmetric ones are the rule in a headset
  // Triangles that the lenses cannot show, three corners each, as tangents: nothing need be drawn
  // there.
  std::vector<Vec2f> hidden;
};

// Views of one size, drawn by one multiview pass: a window's one, a headset's two, the outer or
// the inner two of a headset with four.
struct ViewGroup {
  std::uint32_t width = 1, height = 1;  // pixels of each view's picture
  std::vector<View> views;
};

enum class FrameVerdict {
  kDraw,    // the frame will be seen
  kHidden,  // nobody would see it (minimised, headset taken off): declare nothing for the display
  kQuit,    // the user closed it: no frame began
};

// The tracking of a wearer beside the head, in the world.
struct Tracked {
  // Left, then right; origin at the wrist. Axes as a standing person's while the arm hangs with the
  // palm to the thigh: x right, y from the fingers to the wrist, z backwards.
  std::array<std::optional<Pose>, 2> hands;
  struct Gaze {
    Pose pose;              // between the eyes, which look along -z
    TimeNs sampled_ns = 0;  // when the eyes were measured, on the host clock
  };
  std::optional<Gaze> gaze;
};

struct DisplayFrame {
  FrameVerdict verdict = FrameVerdict::kHidden;
  // When the picture will be seen, on the host clock. Absent: no screen paces the frames, so that
  // the program's clock does.
  std::optional<TimeNs> display_at_ns;
  // Between two pictures of the screen, above 0; absent beside an absent display_at_ns, and while
  // nothing is shown.
  std::optional<TimeNs> period_ns;
  // Where the display tracks its wearer's head; absent: the program's camera is the head.
  std::optional<Pose> world_from_head;
  Tracked tracked;
  std::vector<ViewGroup> groups;  // with kDraw at least one
  // The only view of a window beside a headset (MirroredDisplay): a part of the first group's first
  // view. Absent: there is none, or it takes no picture in this frame.
  std::optional<ViewGroup> mirror;
};

// The pictures of a group's views.
struct ProjectionLayer {
  std::size_t group = 0;
  graph::ImageHandle color;  // sRGB-encoded RGBA8, an array layer a view; any size: it is scaled
  // Optional: reversed Z with an infinite far plane, so planar metres = near_m / depth; D32, of any
  // size up to the group's.
  graph::ImageHandle depth;
  double near_m = 0.0;
};

// A rectangle of a picture: 0 to 1 from its left and its top.
struct PanelPart {
  double left = 0.0, top = 0.0, right = 1.0, bottom = 1.0;
};

// A flat picture over what the layers before it show.
struct PanelLayer {
  enum class Lock { kHead, kWorld };
  std::string name;
  // sRGB-encoded RGBA8, colour multiplied by alpha. A headset keeps a panel's image by its name: an
  // empty handle shows the last one again.
  graph::ImageHandle image;
  Lock lock = Lock::kHead;
  Pose pose;         // of its centre in the head's frame or the world's: x right, y up, z to the
                     // viewer
  Vec2 size_m{1.0};  // width and height; of a bent one along the arc
  // Bent sideways around its viewer, by this radius, where the display can do that; 0: flat.
  double radius_m = 0.0;
  // Disjoint; the picture is clear outside of them, so that a display may leave that out.
  std::vector<PanelPart> parts{PanelPart{}};
  bool mirror_only = false;  // of the window beside a headset: its wearer does not see it
};

using Layer = std::variant<ProjectionLayer, PanelLayer>;

// The picture of a frame's first group, for a screenshot.
struct ShownPicture {
  graph::ImageHandle image;
  VkFormat format = VK_FORMAT_UNDEFINED;
  std::uint32_t width = 1, height = 1;
  bool readable = false;  // a transfer may read it
};

class Display {
 public:
  virtual ~Display() = default;
  // The groups of views that frames will have, known before the first: whoever draws can make ready
  // for them, since a late frame is seen as a fault. Empty: frames may come late, or the groups are
  // not known yet. Where the views look is known with a frame alone.
  virtual std::vector<ViewGroup> groups_ahead() const { return {}; }
  // Waits until the display wants a frame; one without a screen does not wait. world_from_stage:
  // where the space in which the display tracks lies in the world; displays without tracking do not
  // use it.
  virtual Result<DisplayFrame> begin_frame(const Pose& world_from_stage) = 0;
  // Whether begin_frame returns when the next frame should begin for the device to be ready for it
  // (a headset's runtime); else whoever draws waits for the device.
  virtual bool paces_device() const { return false; }
  // Reads the head's and the views' poses again, for the same display time: as late as the frame
  // allows, just before the views are declared. The stage may have moved since begin_frame.
  // Displays without tracking change nothing.
  virtual void track(DisplayFrame&, const Pose& /*world_from_stage*/) {}
  // Adds the passes that bring the layers to the display, in this order, each over the ones before.
  // world_from_head: from where the projection layers were drawn.
  virtual Result<ShownPicture> declare(graph::FrameGraph& graph, const Pose& world_from_head,
                                       std::span<const Layer> layers) = 0;
  // The semaphores that the submission of a frame with declared layers waits for and signals.
  virtual gpu::Frames::SubmitSync sync() const = 0;
  // Ends the frame; each frame that began is ended. submitted: its layers were declared and their
  // submission used sync(), so they are shown; else nothing is.
  virtual Status end_frame(bool submitted) = 0;
  // The user's actions since the last call, by the table that the display was made with.
  // claims: devices that panels use now; their controls do nothing else.
  virtual ActionValues take_actions(const InputClaims& claims) = 0;
  // The same of whoever watches the user in a window beside; no values where none is.
  virtual ActionValues take_mirror_actions(const InputClaims&) { return {}; }
};

}  // namespace neritic::xr
