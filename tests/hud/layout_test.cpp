// Pictures of all layouts: large enough to be read, in contrast over any water, right at their
// edges, drawn only when they change, and as their goldens. A golden sheet has one layout with all
// alarms over blue, green and black water; NERITIC_UPDATE_GOLDEN=1 (tools/golden) writes them anew.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "engine/core/files.hpp"
#include "engine/scene/image_file.hpp"
#include "tests/hud/dives.hpp"
#include "tests/support/support.hpp"

namespace {
std::atomic<std::size_t> allocations{0};
}  // namespace

// Counts what the heap is asked for in this program.
void* operator new(std::size_t size) {
  ++allocations;
  if (void* const at = std::malloc(size == 0 ? 1 : size)) return at;
  throw std::bad_alloc();
}
void operator delete(void* at) noexcept {
  std::free(at);
}
void operator delete(void* at, std::size_t) noexcept {
  std::free(at);
}

namespace neritic::hud {
namespace {

namespace fs = std::filesystem;

// sRGB of sunlit blue water, of green water, and of night.
constexpr std::array<std::array<int, 3>, 3> kWaters{{{70, 160, 215}, {105, 165, 95}, {0, 0, 0}}};

const std::vector<StreamHealth>& streams() {
  static const std::vector<StreamHealth> list{{"diver: body", "live from suit", Health::kGood},
                                              {"diver: heart", "strap is silent", Health::kLost},
                                              {"diver: gaze", "never heard", Health::kWaiting},
                                              {"rov: wrench", "autopilot", Health::kGood}};
  return list;
}

OperatorData about() {
  return {
      .gaze = Vec2(0.47, 0.42), .streams = streams(), .sonar = "rov sonar", .camera = "rov camera"};
}

Hud hud_of(LayoutKind kind, const DiveData& data, double scale = 1.0,
           Units units = Units::kMetric) {
  const auto height = static_cast<std::uint32_t>(std::lround(scale * layout_of(kind).height_px));
  Hud hud(kind, units, height);
  if (kind == LayoutKind::kConsole && std::isfinite(data.depth_m)) fill_minute(hud, data);
  hud.update(data, data.time_s, about());
  return hud;
}

ImageU8 over(const ImageU8& rgba, const std::array<int, 3>& water) {
  ImageU8 out(rgba.width, rgba.height, 3);
  for (std::size_t i = 0; i < std::size_t{rgba.width} * rgba.height; ++i)
    for (std::size_t c = 0; c < 3; ++c)
      out.data[3 * i + c] = static_cast<std::uint8_t>(std::min(
          255, rgba.data[4 * i + c] + (water[c] * (255 - rgba.data[4 * i + 3]) + 127) / 255));
  return out;
}

// WCAG 2.2: the part of a channel's level in the relative luminance, by channel.
const std::array<std::array<double, 256>, 3>& luminance_table() {
  static const auto table = [] {
    std::array<std::array<double, 256>, 3> out{};
    constexpr double kWeights[] = {0.2126, 0.7152, 0.0722};
    for (int c = 0; c < 3; ++c)
      for (int i = 0; i < 256; ++i) {
        const double v = i / 255.0;
        out[c][i] = kWeights[c] * (v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4));
      }
    return out;
  }();
  return table;
}

// The relative luminance of a premultiplied pixel over water.
double luminance(const std::uint8_t* p, const int* water) {
  static const double *red = luminance_table()[0].data(), *green = luminance_table()[1].data(),
                      *blue = luminance_table()[2].data();
  const int through = 255 - p[3];
  return red[p[0] + water[0] * through / 255] + green[p[1] + water[1] * through / 255] +
         blue[p[2] + water[2] * through / 255];
}

// The longest texts that numbers have.
DiveData long_dive(bool in_stops) {
  DiveData d = in_stops ? stops_dive() : calm_dive();
  constexpr double kInf = std::numeric_limits<double>::infinity();
  d.dive_min = 999.9, d.depth_m = d.deepest_m = 299.6, d.to_surface_min = kInf, d.gas_min = kInf;
  d.stop_min = kInf, d.gas = {0.10, 0.70}, d.tank_pa = 299e5, d.cns_percent = 5000.0;
  d.po2_bar = 12.0, d.ascent_m_min = 188.0;
  if (in_stops)
    d.ceiling_m = 118.3, d.stop_m = 120.0;
  else
    d.no_stop_min = kInf;
  return d;
}

// The longest words of an alarm, with all others.
DiveData wordy_dive() {
  DiveData d = stops_dive();
  d.depth_m = d.deepest_m = 150.0, d.ceiling_m = 118.3, d.stop_m = 120.0;
  d.tank_pa = 1e5, d.out_of_gas = true, d.po2_bar = 1.7;
  return d;
}

// Messages by modem: short, of 64 bytes, without a space, in other letters, beside an alarm.
std::vector<NamedDive> messages() {
  std::vector<NamedDive> dives;
  for (const char* const words :
       {"FOLLOW ME", "COME BACK TO THE ANCHOR LINE NOW, YOUR GAS IS LOW, I LIGHT IT UP",
        "WWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWW",
        "\u00c9toile \u00e0 b\u00e2bord \u03b1 42\u00b0, tournez \u00e0 droite"}) {
    DiveData d = calm_dive();
    d.message = words, d.message_from = "a vehicle with a long name, one", d.message_age_s = 3.0;
    dives.push_back({words, d});
  }
  DiveData alarmed = alarmed_dive(Alarm::kGas, AlarmLevel::kDanger);
  alarmed.message = "FOLLOW ME", alarmed.message_from = "rov", alarmed.message_age_s = 0.0;
  dives.push_back({"message and alarm", alarmed});
  return dives;
}

std::vector<NamedDive> tested_dives() {
  std::vector<NamedDive> dives = all_dives();
  for (NamedDive& dive : messages()) dives.push_back(std::move(dive));
  dives.push_back({"long", long_dive(false)});
  dives.push_back({"long stops", long_dive(true)});
  dives.push_back({"wordy", wordy_dive()});
  return dives;
}

TEST(HudLayout, EveryTextIsLargeEnoughToBeRead) {
  for (const Layout& layout : layouts()) {
    const double px_deg = pixels_a_degree(layout);
    EXPECT_GE(px_deg, kLeastPixels_deg) << layout.name;
    EXPECT_NEAR(layout.size_m.x / layout.size_m.y, double(layout.width_px) / layout.height_px, 0.02)
        << layout.name;
    for (const NamedDive& dive : tested_dives()) {
      const Hud hud = hud_of(layout.kind, dive.data);
      ASSERT_GT(hud.marks().size(), 12u);
      for (const TextMark& mark : hud.marks())
        EXPECT_GE(mark.size / px_deg, kLeastText_deg)
            << layout.name << " " << dive.name << " at " << mark.box.x << ", " << mark.box.y;
    }
  }
}

TEST(HudLayout, DepthIsTheLargestNumber) {
  for (const Layout& layout : layouts()) {
    const Hud hud = hud_of(layout.kind, calm_dive());
    double largest = 0.0;
    for (const TextMark& mark : hud.marks()) largest = std::max(largest, mark.size);
    EXPECT_GE(largest / pixels_a_degree(layout), 1.5) << layout.name;
  }
}

TEST(HudLayout, NoTextLeavesThePictureOrMeetsAnother) {
  const std::vector<NamedDive> dives = tested_dives();
  for (const Layout& layout : layouts())
    for (std::size_t of = 0; of < 2 * dives.size(); ++of) {
      const NamedDive& dive = dives[of / 2];
      const Hud hud =
          hud_of(layout.kind, dive.data, 1.0, of % 2 == 0 ? Units::kMetric : Units::kImperial);
      const auto marks = hud.marks();
      for (std::size_t i = 0; i < marks.size(); ++i) {
        const Box& a = marks[i].box;
        EXPECT_TRUE(a.x >= 0.0 && a.y >= 0.0 && a.right() <= layout.width_px &&
                    a.bottom() <= layout.height_px)
            << layout.name << " " << dive.name << " " << i;
        for (std::size_t j = 0; j < i; ++j) {
          const Box& b = marks[j].box;
          EXPECT_FALSE(a.x < b.right() - 0.5 && b.x < a.right() - 0.5 && a.y < b.bottom() - 0.5 &&
                       b.y < a.bottom() - 0.5)
              << layout.name << " " << dive.name << ": " << i << " and " << j << " at " << a.x
              << ", " << a.y;
        }
      }
    }
}

bool shows(const Hud& hud, std::string_view words) {
  return std::ranges::any_of(hud.marks(),
                             [&](const TextMark& mark) { return mark.text.view() == words; });
}

TEST(HudLayout, AMessageIsShownForAWhileAndAfterAnyAlarm) {
  for (const Layout& layout : layouts()) {
    const bool console = layout.kind == LayoutKind::kConsole;
    DiveData d = calm_dive();
    d.message = "FOLLOW ME", d.message_from = "rov", d.message_age_s = 0.0;
    EXPECT_TRUE(shows(hud_of(layout.kind, d), "FOLLOW ME")) << layout.name;
    EXPECT_TRUE(shows(hud_of(layout.kind, d), "rov")) << layout.name;
    d.message_age_s = kMessage_s + 0.1;
    EXPECT_FALSE(shows(hud_of(layout.kind, d), "FOLLOW ME")) << layout.name;
    d.message_age_s = kUnknown;
    EXPECT_FALSE(shows(hud_of(layout.kind, d), "FOLLOW ME")) << layout.name;
    const NamedDive alarmed = messages().back();
    EXPECT_EQ(shows(hud_of(layout.kind, alarmed.data), "FOLLOW ME"), console) << layout.name;
    // In two lines, whole.
    const NamedDive wordy = messages()[1];
    EXPECT_TRUE(shows(hud_of(layout.kind, wordy.data),
                      FixedText("COME BACK TO THE ANCHOR LINE NOW,").view()))
        << layout.name;
  }
}

// By the pixels: the brightest and the darkest of each text's box, over each water.
TEST(HudLayout, EveryTextHasAContrastOfSevenOverBlueGreenAndBlackWater) {
  std::vector<NamedDive> dives = all_dives();
  for (NamedDive& dive : messages()) dives.push_back(std::move(dive));
  for (const Layout& layout : layouts())
    for (const NamedDive& dive : dives) {
      const Hud hud = hud_of(layout.kind, dive.data);
      const ImageU8& picture = hud.picture();
      for (const auto& water : kWaters)
        for (const TextMark& mark : hud.marks()) {
          double low = 1.0, high = 0.0;
          const auto to = [](double v) { return static_cast<std::uint32_t>(std::max(0.0, v)); };
          const std::uint32_t left = to(mark.box.x),
                              right = std::min(to(mark.box.right() + 1.0), picture.width),
                              bottom = std::min(to(mark.box.bottom() + 1.0), picture.height);
          for (std::uint32_t y = to(mark.box.y); y < bottom; ++y) {
            const std::uint8_t* row = picture.data.data() + std::size_t{4} * y * picture.width;
            for (std::uint32_t x = left; x < right; ++x) {
              const double l = luminance(row + 4 * x, water.data());
              if (l < low) low = l;
              if (l > high) high = l;
            }
          }
          EXPECT_GE((high + 0.05) / (low + 0.05), 7.0)
              << layout.name << " " << dive.name << " over water of red " << water[0] << " at "
              << mark.box.x << ", " << mark.box.y;
        }
    }
}

// Brightness alone shows each alarm, over a hundredth of the layout and more.
TEST(HudLayout, AnAlarmIsSeenWithoutColour) {
  for (const Layout& layout : layouts()) {
    const Hud calm = hud_of(layout.kind, calm_dive());
    for (std::size_t i = 0; i < kAlarms; ++i) {
      const Hud hud =
          hud_of(layout.kind, alarmed_dive(static_cast<Alarm>(i), AlarmLevel::kCaution));
      std::size_t differ = 0;
      for (std::uint32_t y = 0; y < layout.height_px; y += 4)
        for (std::uint32_t x = 0; x < layout.width_px; x += 4)
          differ += std::abs(luminance(&hud.picture().at(x, y), kWaters[2].data()) -
                             luminance(&calm.picture().at(x, y), kWaters[2].data())) > 0.2;
      EXPECT_GT(differ, layout.width_px * layout.height_px / 1600) << layout.name << " " << i;
    }
  }
}

// Over any water the picture is what drawing on that water gives, and no colour exceeds its alpha.
TEST(HudLayout, AlphaIsRightAtEveryEdge) {
  for (const Layout& layout : layouts()) {
    const Hud hud = hud_of(layout.kind, calm_dive());
    const ImageU8& rgba = hud.picture();
    ASSERT_EQ(rgba.channels, 4u);
    std::size_t edges = 0;
    for (std::size_t i = 0; i < rgba.data.size(); i += 4) {
      const std::uint8_t alpha = rgba.data[i + 3];
      edges += alpha > 0 && alpha < 255;
      for (std::size_t c = 0; c < 3; ++c) ASSERT_LE(rgba.data[i + c], alpha) << layout.name;
    }
    EXPECT_GT(edges, 100u) << layout.name;
    for (const auto& water : kWaters) {
      ImageU8 plain(rgba.width, rgba.height, 3);
      for (std::size_t i = 0; i < plain.data.size(); ++i)
        plain.data[i] = static_cast<std::uint8_t>(water[i % 3]);
      draw2d::Canvas canvas(std::move(plain));
      std::vector<TextMark> marks;
      Painter painter(canvas, 1.0, marks);
      draw(layout.kind, painter, hud.shown());
      const ImageU8 seen = over(rgba, water);
      int worst = 0;
      for (std::size_t i = 0; i < seen.data.size(); ++i)
        worst = std::max(worst, std::abs(int(seen.data[i]) - int(canvas.image().data[i])));
      EXPECT_LE(worst, 3) << layout.name;
    }
  }
}

TEST(HudLayout, WhatStaysTheSameIsNotDrawnAgainAndAllocatesNothing) {
  for (const Layout& layout : layouts()) {
    Hud hud(layout.kind, Units::kMetric, layout.height_px / 2);
    DiveData d = calm_dive();
    EXPECT_TRUE(hud.update(d, d.time_s, about())) << layout.name;
    const std::size_t before = allocations;
    bool changed = false;
    for (int i = 0; i < 100; ++i) changed |= hud.update(d, d.time_s, about());
    EXPECT_FALSE(changed) << layout.name;
    EXPECT_EQ(allocations, before) << layout.name;
    d.depth_m += 0.1;
    EXPECT_TRUE(hud.update(d, d.time_s, about())) << layout.name;
  }
  EXPECT_GT(allocations, 0u);
}

TEST(HudLayout, NoTextOfTheConsoleTouchesItsPlatesFrame) {
  constexpr double kLeast_px = 4.0;
  for (const Units units : {Units::kMetric, Units::kImperial})
    for (const NamedDive& dive : tested_dives()) {
      const Hud hud = hud_of(LayoutKind::kConsole, dive.data, 1.0, units);
      for (const TextMark& mark : hud.marks())
        for (const Box& plate : console_plates(hud.shown())) {
          const Box& a = mark.box;
          if (a.right() < plate.x || a.x > plate.right() || a.bottom() < plate.y ||
              a.y > plate.bottom())
            continue;
          EXPECT_TRUE(a.x >= plate.x + kLeast_px && a.right() <= plate.right() - kLeast_px &&
                      a.y >= plate.y + kLeast_px && a.bottom() <= plate.bottom() - kLeast_px)
              << dive.name << ": \"" << mark.text.view() << "\" at " << a.x << ", " << a.y;
        }
    }
}

// Neither picture has a place where the scene has no such sensor; beside both the streams leave
// room, and say how many are left out.
TEST(HudLayout, ThePicturesPlacesAreThereWhereTheSceneHasThem) {
  std::vector<StreamHealth> many(9, streams()[0]);
  for (const bool sonar : {false, true})
    for (const bool camera : {false, true})
      for (std::size_t count = 0; count <= many.size(); ++count) {
        OperatorData about{.streams = std::span(many).first(count)};
        if (sonar) about.sonar = "sonar";
        if (camera) about.camera = "camera";
        Hud hud(LayoutKind::kConsole, Units::kMetric, 720);
        hud.update(calm_dive(), 0.0, about);
        const Shown& s = hud.shown();
        EXPECT_EQ(sonar_place(s).has_value(), sonar);
        EXPECT_EQ(camera_place(s).has_value(), camera);
        EXPECT_EQ(s.stream_count + s.more_streams, count);
        const auto plates = console_plates(s);
        for (std::size_t i = 0; i < plates.size(); ++i)
          for (std::size_t j = 0; j < i; ++j) {
            const Box &a = plates[i], &b = plates[j];
            EXPECT_FALSE(a.x < b.right() && b.x < a.right() && a.y < b.bottom() && b.y < a.bottom())
                << sonar << camera << count << ": " << i << " and " << j;
          }
      }
}

// The console's graphs have the unit at both ends of their axes, metric and imperial.
TEST(HudLayout, NoNumberOfAGraphIsWithoutItsUnit) {
  for (const Units units : {Units::kMetric, Units::kImperial}) {
    const Hud hud = hud_of(LayoutKind::kConsole, calm_dive(), 1.0, units);
    std::string all;
    for (const TextMark& mark : hud.marks()) all += std::string(mark.text.view()) + "\n";
    const bool metric = units == Units::kMetric;
    for (const char* text : {"180/min", "40/min", metric ? "7.0 l" : "14.8 pt",
                             metric ? "0.0 l" : "0.0 pt", "pO2 bar", "beats/min", "breaths/min",
                             metric ? "m/min" : "ft/min", metric ? "MOD 33 m" : "MOD 110 ft"})
      EXPECT_NE(all.find(text), std::string::npos) << text << " in\n" << all;
  }
}

// Every layout names the unit of its rate, its depths and its oxygen.
TEST(HudLayout, EachNamesTheUnitOfRateDepthAndOxygen) {
  for (const Layout& layout : layouts())
    for (const Units units : {Units::kMetric, Units::kImperial}) {
      const Hud hud = hud_of(layout.kind, calm_dive(), 1.0, units);
      std::string all;
      for (const TextMark& mark : hud.marks()) all += std::string(mark.text.view()) + "\n";
      for (const std::string& text : {std::string("pO2 bar"), std::string(unit_names(units).rate),
                                      std::string("DEPTH ") + unit_names(units).depth})
        EXPECT_NE(all.find(text), std::string::npos) << layout.name << ": " << text;
    }
}

// A diver looks for the jacket on each layout: its gas, its lift and each button make another
// picture; so does the ceiling while stops are owed.
TEST(HudLayout, EachShowsTheJacketAndTheCeiling) {
  for (const Layout& layout : layouts()) {
    const auto differs = [&](const DiveData& from, auto change) {
      DiveData to = from;
      change(to);
      return hud_of(layout.kind, from).picture().data != hud_of(layout.kind, to).picture().data;
    };
    const DiveData calm = calm_dive(), stops = stops_dive();
    EXPECT_TRUE(differs(calm, [](DiveData& d) { d.jacket_m3 += 1e-4; })) << layout.name;
    EXPECT_TRUE(differs(calm, [](DiveData& d) { d.lift_n += 1.0; })) << layout.name;
    EXPECT_TRUE(differs(calm, [](DiveData& d) { d.buttons = 0; })) << layout.name;
    EXPECT_TRUE(differs(calm, [](DiveData& d) { d.buttons = diver::kDeflate; })) << layout.name;
    EXPECT_TRUE(differs(calm, [](DiveData& d) { d.buttons |= diver::kDump; })) << layout.name;
    EXPECT_TRUE(differs(stops, [](DiveData& d) { d.ceiling_m += 0.2; })) << layout.name;
  }
}

TEST(HudLayout, AScaleDrawsTheSamePictureFiner) {
  for (const Layout& layout : layouts()) {
    const Hud twice = hud_of(layout.kind, calm_dive(), 1.5);
    EXPECT_EQ(twice.picture().height, std::lround(1.5 * layout.height_px));
    EXPECT_EQ(twice.picture().width, std::lround(1.5 * layout.width_px));
    const Hud once = hud_of(layout.kind, calm_dive());
    ASSERT_EQ(once.marks().size(), twice.marks().size());
    for (std::size_t i = 0; i < once.marks().size(); ++i)
      EXPECT_NEAR(once.marks()[i].box.x, twice.marks()[i].box.x, 0.5) << layout.name;
  }
}

// The wearer's left and up: an arm across the chest, its back to the eyes.
TEST(HudLayout, TheWristsScreenLiesOnTheArmAndEveryOtherFacesTheEyes) {
  const Layout& wrist = layout_of(LayoutKind::kWrist);
  const Mat3 hand_from_panel = glm::mat3_cast(wrist.lock_from_panel.rotation);
  EXPECT_LT(glm::length(hand_from_panel[0] - Vec3(0, -1, 0)), 1e-9);
  EXPECT_LT(glm::length(hand_from_panel[2] - Vec3(-1, 0, 0)), 1e-9);
  EXPECT_NEAR(glm::determinant(hand_from_panel), 1.0, 1e-9);
  for (const Layout& layout : layouts()) {
    const Vec3 to_eye = -layout.head_from_panel.position_m;
    const Vec3 normal = layout.head_from_panel.rotation * Vec3(0, 0, 1);
    EXPECT_NEAR(glm::length(to_eye), layout.viewing_m, 0.03) << layout.name;
    EXPECT_GT(glm::dot(glm::normalize(to_eye), normal), std::cos(radians(3.0))) << layout.name;
  }
}

// Degrees to the right and up from straight ahead, of a panel's whole face as it is held before the
// eyes.
struct SeenBox {
  double left = 360.0, right = -360.0, bottom = 360.0, top = -360.0;
};
SeenBox seen_of(const Layout& layout) {
  SeenBox out;
  for (int i = 0; i <= 20; ++i)
    for (int j = 0; j <= 20; ++j) {
      const double x = layout.size_m.x * (i / 20.0 - 0.5), y = layout.size_m.y * (j / 20.0 - 0.5);
      const double r = layout.radius_m;
      const Vec3 on =
          r > 0.0 ? Vec3(r * std::sin(x / r), y, r - r * std::cos(x / r)) : Vec3(x, y, 0);
      const Vec3 at = layout.head_from_panel.position_m + layout.head_from_panel.rotation * on;
      const double across = degrees(std::atan2(at.x, -at.z));
      const double up = degrees(std::atan2(at.y, std::hypot(at.x, at.z)));
      out = {std::min(out.left, across), std::max(out.right, across), std::min(out.bottom, up),
             std::max(out.top, up)};
    }
  return out;
}

// The diver's own layouts may be worn together; the operator's console covers the view.
TEST(HudLayout, NoneOfThoseThatADiverWearsCoversAnother) {
  constexpr double kLeast_deg = 0.3;
  for (const Layout& one : layouts())
    for (const Layout& other : layouts()) {
      if (&one == &other || one.lock == Lock::kWorld || other.lock == Lock::kWorld) continue;
      const SeenBox a = seen_of(one), b = seen_of(other);
      EXPECT_TRUE(a.left > b.right + kLeast_deg || b.left > a.right + kLeast_deg ||
                  a.bottom > b.top + kLeast_deg || b.bottom > a.top + kLeast_deg)
          << one.name << " from " << a.left << " to " << a.right << ", " << a.bottom << " to "
          << a.top << "; " << other.name << " from " << b.left << " to " << b.right << ", "
          << b.bottom << " to " << b.top;
    }
}

// All dives of a layout, each over one of the waters, side by side.
ImageU8 sheet_of(const Layout& layout) {
  const auto dives = all_dives();
  const double scale = layout.kind == LayoutKind::kConsole ? 0.75 : 1.0;
  const std::uint32_t columns = layout.kind == LayoutKind::kMask ? 1 : 2;
  const auto rows = static_cast<std::uint32_t>((dives.size() + columns - 1) / columns);
  ImageU8 sheet;
  for (std::size_t i = 0; i < dives.size(); ++i) {
    const ImageU8 one = over(hud_of(layout.kind, dives[i].data, scale).picture(), kWaters[i % 3]);
    if (sheet.empty()) sheet = ImageU8(columns * one.width, rows * one.height, 3);
    const auto left = static_cast<std::uint32_t>(i % columns) * one.width,
               top = static_cast<std::uint32_t>(i / columns) * one.height;
    for (std::uint32_t y = 0; y < one.height; ++y)
      std::copy_n(&one.at(0, y), 3 * one.width, &sheet.at(left, top + y));
  }
  return sheet;
}

TEST(HudLayout, EachLayoutWithEachAlarmIsAsItsGolden) {
  const char* update = std::getenv("NERITIC_UPDATE_GOLDEN");
  for (const Layout& layout : layouts()) {
    const std::string name = std::string(layout.name) + ".png";
    const fs::path golden = test::source_dir() / "tests" / "hud" / "golden" / name;
    const ImageU8 sheet = sheet_of(layout);
    if (update && std::string(update) == "1") {
      ASSERT_TRUE(scene::write_png8(golden, sheet).ok());
      continue;
    }
    const ImageU8 wanted = scene::read_image8(golden, 3).value();
    ASSERT_EQ(wanted.width, sheet.width) << name;
    ASSERT_EQ(wanted.height, sheet.height) << name;
    std::size_t differ = 0;
    for (std::size_t i = 0; i < sheet.data.size(); ++i)
      differ += std::abs(int(sheet.data[i]) - int(wanted.data[i])) > 8;
    const std::size_t most = sheet.data.size() / 1000;
    EXPECT_LE(differ, most) << name << "; see golden/hud_" << name << " in the build folder";
    if (differ <= most) continue;
    const fs::path folder = fs::path(NERITIC_BINARY_DIR) / "golden";
    ASSERT_TRUE(make_folder(folder).ok());
    ASSERT_TRUE(scene::write_png8(folder / ("hud_" + name), sheet).ok());
  }
}

}  // namespace
}  // namespace neritic::hud
