#include "tests/fakes/openxr/script.hpp"

#include <fmt/format.h>

#include <functional>
#include <sstream>

namespace neritic::fakes {
namespace {

// The words of one line after its key.
struct Words {
  std::istringstream in;
  bool good = true;

  std::string word() {
    std::string text;
    good = good && (in >> text);
    return text;
  }
  double number() {
    double value = 0;
    good = good && (in >> value);
    return value;
  }
  bool more() { return good && !(in >> std::ws).eof(); }
  std::string rest() {
    std::string text;
    std::getline(in >> std::ws, text);
    good = good && !text.empty();
    return text;
  }
  bool yes() {
    const std::string text = word();
    good = good && (text == "yes" || text == "no");
    return text == "yes";
  }
  std::size_t side() {
    const std::string text = word();
    good = good && (text == "left" || text == "right");
    return text == "right";
  }
  // X Y Z [YAW [PITCH [ROLL]]]
  Pose pose() {
    Pose pose;
    for (int i = 0; i < 3; ++i) pose.position[i] = number();
    if (more()) pose.rotation = rotation();
    return pose;
  }
  glm::dquat rotation() {
    const double yaw = number(), pitch = more() ? number() : 0;
    return from_degrees(yaw, pitch, more() ? number() : 0);
  }
};

const std::map<std::string, std::int64_t>& format_names() {
  static const std::map<std::string, std::int64_t> names{
      {"R8G8B8A8_SRGB", VK_FORMAT_R8G8B8A8_SRGB},
      {"B8G8R8A8_SRGB", VK_FORMAT_B8G8R8A8_SRGB},
      {"R8G8B8A8_UNORM", VK_FORMAT_R8G8B8A8_UNORM},
      {"B8G8R8A8_UNORM", VK_FORMAT_B8G8R8A8_UNORM},
      {"A2B10G10R10_UNORM", VK_FORMAT_A2B10G10R10_UNORM_PACK32},
      {"R16G16B16A16_SFLOAT", VK_FORMAT_R16G16B16A16_SFLOAT},
      {"R5G6B5_UNORM", VK_FORMAT_R5G6B5_UNORM_PACK16},
      {"D32_SFLOAT", VK_FORMAT_D32_SFLOAT},
      {"D16_UNORM", VK_FORMAT_D16_UNORM},
      {"D24_UNORM_S8_UINT", VK_FORMAT_D24_UNORM_S8_UINT},
      {"D32_SFLOAT_S8_UINT", VK_FORMAT_D32_SFLOAT_S8_UINT}};
  return names;
}

void read_formats(Words& words, Script& script) {
  script.formats.clear();
  while (words.more()) {
    const auto found = format_names().find(words.word());
    words.good = words.good && found != format_names().end();
    if (words.good) script.formats.push_back(found->second);
  }
}

using Reader = std::function<void(Words&, Script&)>;

Reader number_to(double Script::*member) {
  return [member](Words& words, Script& script) { script.*member = words.number(); };
}
Reader count_to(std::uint32_t Script::*member) {
  return [member](Words& words, Script& script) {
    script.*member = static_cast<std::uint32_t>(words.number());
  };
}
Reader times_to(int Script::*member) {
  return
      [member](Words& words, Script& script) { script.*member = static_cast<int>(words.number()); };
}
Reader yes_to(bool Script::*member) {
  return [member](Words& words, Script& script) { script.*member = words.yes(); };
}
Reader text_to(std::string Script::*member) {
  return [member](Words& words, Script& script) { script.*member = words.rest(); };
}

Reader names_to(std::set<std::string> Script::*member) {
  return [member](Words& words, Script& script) {
    (script.*member).clear();
    while (words.more()) (script.*member).insert(words.word());
  };
}

Reader steps_to(StepTrack<bool> Script::*member) {
  return [member](Words& words, Script& script) {
    const double time = words.number();
    (script.*member).set(time, words.yes());
  };
}

// Keys of what the headset is.
void add_system(std::map<std::string, Reader>& keys) {
  keys["name"] = text_to(&Script::name);
  keys["available"] = yes_to(&Script::available);
  keys["instance_refusals"] = times_to(&Script::instance_refusals);
  keys["system_refusals"] = times_to(&Script::system_refusals);
  keys["views"] = times_to(&Script::views);
  keys["size"] = [](Words& words, Script& script) {
    script.focus_width = script.width = static_cast<std::uint32_t>(words.number());
    script.focus_height = script.height = static_cast<std::uint32_t>(words.number());
  };
  keys["focus_size"] = [](Words& words, Script& script) {
    script.focus_width = static_cast<std::uint32_t>(words.number());
    script.focus_height = static_cast<std::uint32_t>(words.number());
  };
  keys["max_size"] = count_to(&Script::max_size);
  keys["fov"] = [](Words& words, Script& script) {
    for (double& angle : script.fov_left) angle = words.number();
  };
  keys["focus_deg"] = number_to(&Script::focus_deg);
  keys["eye_distance"] = number_to(&Script::eye_distance_m);
  keys["cant"] = number_to(&Script::cant_deg);
  keys["formats"] = read_formats;
  keys["images"] = count_to(&Script::swapchain_length);
  keys["image_timeouts"] = times_to(&Script::image_timeouts);
  keys["max_layers"] = count_to(&Script::max_layers);
  keys["without"] = [](Words& words, Script& script) {
    while (words.more()) script.without.insert(words.word());
  };
  keys["vulkan_instance_extensions"] = names_to(&Script::vulkan_instance);
  keys["vulkan_device_extensions"] = names_to(&Script::vulkan_device);
  keys["stage"] = yes_to(&Script::stage);
  keys["local"] = [](Words& words, Script& script) { script.local = words.pose(); };
  keys["refresh_rates"] = [](Words& words, Script& script) {
    script.refresh_rates.clear();
    while (words.more()) script.refresh_rates.push_back(static_cast<float>(words.number()));
  };
}

// Keys of time and of the person.
void add_person(std::map<std::string, Reader>& keys) {
  keys["period"] = number_to(&Script::period_s);
  keys["lead"] = number_to(&Script::lead_periods);
  keys["gaze_period"] = number_to(&Script::gaze_period_s);
  keys["real_time"] = yes_to(&Script::real_time);
  keys["late"] = [](Words& words, Script& script) {
    const auto frame = static_cast<std::uint64_t>(words.number());
    script.late[frame] = static_cast<int>(words.number());
  };
  keys["head"] = [](Words& words, Script& script) {
    const double time = words.number();
    script.head.set(time, words.pose());
  };
  keys["tracked"] = steps_to(&Script::tracked);
  keys["oriented"] = steps_to(&Script::oriented);
  keys["positioned"] = steps_to(&Script::positioned);
  keys["hand"] = [](Words& words, Script& script) {
    PoseTrack& hand = script.hands[words.side()];
    const double time = words.number();
    hand.set(time, words.pose());
  };
  keys["hands_seen"] = yes_to(&Script::hands_seen);
  keys["curl"] = [](Words& words, Script& script) {
    StepTrack<double>& curl = script.curls[words.side()];
    const double time = words.number();
    curl.set(time, words.number());
  };
  keys["gaze"] = [](Words& words, Script& script) {
    const double time = words.number();
    script.gaze.set(time, {{}, words.rotation()});
  };
  keys["controller"] = [](Words& words, Script& script) {
    PoseTrack& grip = script.controllers[words.side()].grip;
    const double time = words.number();
    grip.set(time, words.pose());
  };
  keys["profile"] = [](Words& words, Script& script) {
    const std::string who = words.word(), profile = words.word();
    const std::string path = profile == "none" ? "" : "/interaction_profiles/" + profile;
    if (who == "left" || who == "both") script.controllers[0].profile = path;
    if (who == "right" || who == "both") script.controllers[1].profile = path;
    if (who == "gamepad") script.gamepad = path;
  };
  keys["input"] = [](Words& words, Script& script) {
    const std::string path = words.word();
    const double time = words.number(), x = words.number();
    script.inputs[path].set(time, {x, words.more() ? words.number() : 0});
  };
}

// Keys of pictures and of what happens.
void add_run(std::map<std::string, Reader>& keys) {
  keys["out"] = text_to(&Script::out);
  keys["out_frames"] = [](Words& words, Script& script) {
    while (words.more()) script.out_frames.insert(static_cast<std::uint64_t>(words.number()));
  };
  keys["background"] = [](Words& words, Script& script) {
    for (double& channel : script.background) channel = words.number();
  };
  keys["main_visible"] = yes_to(&Script::main_visible);
  keys["report"] = text_to(&Script::report);
  keys["fails"] = [](Words& words, Script& script) {
    ScriptedFailure& failure = script.failures[words.word()];
    failure = {.times = static_cast<int>(words.number())};
    if (words.more()) failure.after = static_cast<int>(words.number());
  };
  keys["frame"] = [](Words& words, Script& script) {
    const auto frame = static_cast<std::uint64_t>(words.number());
    script.timed.push_back({frame, words.rest()});
  };
}

const std::map<std::string, Reader>& readers() {
  static const std::map<std::string, Reader> all = [] {
    std::map<std::string, Reader> keys;
    add_system(keys);
    add_person(keys);
    add_run(keys);
    return keys;
  }();
  return all;
}

}  // namespace

std::optional<std::string> read_script(const std::string& text, Script& script) {
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    line = line.substr(0, line.find('#'));
    Words words{std::istringstream(line)};
    if (!words.more()) continue;
    const std::string key = words.word();
    const auto reader = readers().find(key);
    if (reader == readers().end()) return fmt::format("line {}: no key '{}'", number, key);
    reader->second(words, script);
    if (!words.good || words.more()) {
      return fmt::format("line {}: '{}' has missing, wrong or extra words", number, line);
    }
  }
  return {};
}

}  // namespace neritic::fakes
