#include "engine/scene/holdout.h"

#include <algorithm>
#include <limits>

#include "engine/core/error.h"
#include "engine/core/parameter.h"
#include "engine/image/image.h"

namespace freevoxels {

std::shared_ptr<const Holdout> readHoldout(const std::filesystem::path& file) {
  const Image image = readExrDepth(file);
  const glm::ivec2 size = image.wholeSize;
  if (std::max(size.x, size.y) > kMaxImageEdge)
    fail(ErrorKind::Input, "'{}' has {}x{} pixels, and images have at most {} along an edge: write a smaller one", file.string(), size.x,
         size.y, kMaxImageEdge);
  const auto count = std::size_t(size.x) * std::size_t(size.y);
  auto holdout =
      std::make_shared<Holdout>(Holdout{.size = size, .depths = std::vector<float>(count, std::numeric_limits<float>::infinity())});
  const glm::ivec2 begin = glm::max(image.offset, 0), end = glm::min(image.offset + image.size, size);
  for (int y = begin.y; y < end.y; ++y)
    for (int x = begin.x; x < end.x; ++x)
      holdout->depths[std::size_t(x) + std::size_t(y) * std::size_t(size.x)] =
          image.depth[std::size_t(x - image.offset.x) + std::size_t(y - image.offset.y) * std::size_t(image.size.x)];
  checkHoldout(*holdout, fmt::format("'{}'", file.string()));
  return holdout;
}

void checkHoldout(const Holdout& holdout, const std::string& name) {
  FV_CHECK_EQ(holdout.depths.size(), std::size_t(holdout.size.x) * std::size_t(holdout.size.y));
  for (std::size_t i = 0; i < holdout.depths.size(); ++i) {
    if (holdout.depths[i] >= 0.0f) continue;
    const std::size_t width = std::size_t(holdout.size.x);
    fail(ErrorKind::Input,
         "{} has the depth {} at pixel ({}, {}): depths are distances along the viewing axis, 0 or larger, and inf where nothing is", name,
         holdout.depths[i], i % width, i / width);
  }
}

void checkHoldoutSize(const Holdout& holdout, glm::ivec2 imageSize) {
  if (holdout.size == imageSize) return;
  fail(ErrorKind::Usage, "the image of {} has {}x{} pixels, and that to be drawn {}x{}: render one of them in the size of the other",
       Parameter("holdout"), holdout.size.x, holdout.size.y, imageSize.x, imageSize.y);
}

void failHoldoutOfSplats() {
  fail(ErrorKind::Usage, "{} ends rays, which splats have none of: leave out {} and other options of splats", Parameter("holdout"),
       Parameter("draw", "splats"));
}

}  // namespace freevoxels
