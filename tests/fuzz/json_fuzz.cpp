#include <nlohmann/json.hpp>
#include <optional>

#include "engine/core/json_file.h"
#include "engine/description/scene_json.h"
#include "engine/volume/classification.h"
#include "engine/volume/transfer_curves.h"
#include "tests/fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace freevoxels;
  const std::string text(reinterpret_cast<const char*>(bytes), size);
  const fuzz::FuzzFile file(bytes, size);
  Volume volume;
  volume.minimum = 0.0f;
  volume.maximum = 2.0f;
  fuzz::tryTo([&] { transferFunctionJson(fitted(parseTransferCurves("inline", text), volume)); });
  fuzz::tryTo([&] {
    const SceneDescription scene = readScene(file.path());
    sceneToJson(scene, std::nullopt).dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  });
  const nlohmann::json json = parseJsonQuietly(text), copy = json;
  if (!json.is_discarded() && inQuotes(copy) != inQuotes(json)) std::abort();
  return 0;
}
