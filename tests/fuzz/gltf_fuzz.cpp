// Any bytes as a glTF file: an Error in one line, or a model that keeps every promise of model.hpp.
#include "engine/core/check.hpp"
#include "engine/scene/animation.hpp"
#include "engine/scene/gltf_loader.hpp"
#include "tests/fuzz/replay.hpp"
#include "tests/scene/gltf_invariants.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace neritic;
  const auto model = scene::parse_gltf_bytes(fuzz::as_bytes(data, size), "fuzz.gltf");
  if (!model.ok()) {
    const std::string& message = model.error().message;
    NERITIC_CHECK(message.starts_with("fuzz.gltf: ") && message.find('\n') == message.npos, "{}",
                  message);
    return 0;
  }
  const std::string broken = test::broken_promise(*model);
  NERITIC_CHECK(broken.empty(), "{}", broken);
  for (int clip = -1; clip < static_cast<int>(model->clips.size()) && clip < 4; ++clip)
    scene::model_bounds(*model, scene::evaluate_pose(*model, clip, 0.37));
  return 0;
}
