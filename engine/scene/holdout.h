#pragma once
// Surfaces from elsewhere in front of which a volume is drawn, as an image of their depths.

#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

namespace freevoxels {

/// Rays end where they meet the surfaces: light and alpha of a pixel are those of what is in front of its depth.
struct Holdout {
  glm::ivec2 size{0};
  /// The depth of each pixel, row 0 at the top: its distance from the eye along the viewing axis in world units, as Image::depth has it, at
  /// least 0; infinity, or any number beyond the volume, where nothing is in front.
  std::vector<float> depths;
};

/// The depths of an .exr (readExrDepth) of the display window's size, infinity outside of the data window. Fails with ErrorKind::Input, as
/// checkHoldout does.
std::shared_ptr<const Holdout> readHoldout(const std::filesystem::path& file);

/// Fails with ErrorKind::Input for depths that are no distances; `name` is what the sentence calls the image.
void checkHoldout(const Holdout& holdout, const std::string& name);

/// Fails with ErrorKind::Usage unless the holdout has the size of the image.
void checkHoldoutSize(const Holdout& holdout, glm::ivec2 imageSize);

/// Fails with ErrorKind::Usage, as splats have no rays that could end.
[[noreturn]] void failHoldoutOfSplats();

}  // namespace freevoxels
