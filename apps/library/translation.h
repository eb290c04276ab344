#pragma once
// Between the public interface and the engine: errors, scenes, images and times, and what is behind the objects that several files use.
// Only files of this folder include it.

#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "apps/common/frame_queue.h"
#include "apps/common/scene_renderer.h"
#include "apps/library/include/freevoxels/freevoxels.h"
#include "engine/core/error.h"
#include "engine/core/json_file.h"
#include "engine/core/printable.h"

namespace freevoxels::v1 {

using Json = nlohmann::json;

inline ErrorKind kindOf(freevoxels::ErrorKind kind) {
  switch (kind) {
    case freevoxels::ErrorKind::Usage:
      return ErrorKind::Usage;
    case freevoxels::ErrorKind::Input:
      return ErrorKind::Input;
    case freevoxels::ErrorKind::Output:
      return ErrorKind::Output;
    case freevoxels::ErrorKind::Device:
      return ErrorKind::Device;
    case freevoxels::ErrorKind::OutOfMemory:
      return ErrorKind::OutOfMemory;
    default:
      return ErrorKind::Internal;
  }
}

/// The text with its parameters as keys of a scene: "memory-limit", "draw": "splats".
inline std::string withSceneKeys(std::string_view text) {
  return spelled(text, [](std::string_view name, std::string_view value) {
    return value.empty() ? fmt::format("\"{}\"", name) : fmt::format("\"{}\": \"{}\"", name, value);
  });
}

/// Calls `work` and converts the engine's errors to those of this interface.
template <typename Work>
auto translated(const Work& work) {
  try {
    return work();
  } catch (const freevoxels::Error& error) {
    throw Error(kindOf(error.kind()), printable(withSceneKeys(error.text())), error.parameters());
  } catch (const InternalError& error) {
    throw Error(ErrorKind::Internal, fmt::format("internal error, please report it: {}", error.what()));
  } catch (const FrameCancelled&) {
    throw Error(ErrorKind::Cancelled, "the frame was cancelled before it was complete");
  }
}

inline Json parseScene(std::string_view text) {
  if (isTooDeep(text)) fail(freevoxels::ErrorKind::Usage, "a scene is nested at most {} deep, and this one is deeper", kDeepestJson);
  Json scene = parseJson("scene", "inline", text);
  constexpr std::size_t kLongestQuote = 200;
  if (!scene.is_object())
    fail(freevoxels::ErrorKind::Usage, "a scene is a JSON object, as '{{\"size\": [800, 600]}}', not '{}'",
         printablePart(text, kLongestQuote));
  return scene;
}

/// A copy; null if there are no depths.
inline std::shared_ptr<const freevoxels::Holdout> holdoutOf(const Holdout& given) {
  if (given.depths.empty()) return nullptr;
  if (given.width < 1 || given.height < 1 || std::size_t(given.width) * std::size_t(given.height) != given.depths.size())
    fail(freevoxels::ErrorKind::Input, "{} depths are not a holdout of {}x{} pixels", given.depths.size(), given.width, given.height);
  freevoxels::Holdout holdout{.size = {given.width, given.height}, .depths = {given.depths.begin(), given.depths.end()}};
  checkHoldout(holdout, "the holdout");
  return std::make_shared<const freevoxels::Holdout>(std::move(holdout));
}

inline Image imageOf(freevoxels::Image image) {
  const float* const first = reinterpret_cast<const float*>(image.pixels.data());
  return {image.size.x, image.size.y, {first, first + 4 * image.pixels.size()}, std::move(image.depth)};
}

inline std::vector<std::pair<std::string, double>> pairsOf(const std::vector<StageTime>& times) {
  std::vector<std::pair<std::string, double>> pairs;
  for (const StageTime& time : times) pairs.emplace_back(time.name, time.milliseconds);
  return pairs;
}

struct Context::State {
  std::shared_ptr<DeviceContext> context;
};

struct Volume::State {
  std::shared_ptr<const SharedVolume> volume;
};

}  // namespace freevoxels::v1
