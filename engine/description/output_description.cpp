#include "engine/core/error.h"
#include "engine/description/scene_description.h"

namespace freevoxels {

void OutputDescription::checkCrop(glm::ivec2 imageSize) const {
  if (!crop) return;
  const glm::ivec2 end = crop->corner + crop->size;
  if (crop->size.x < 1 || crop->size.y < 1 || end.x > imageSize.x || end.y > imageSize.y)
    fail(ErrorKind::Usage, "{} is no part of an image of {}x{} pixels",
         Parameter("crop", fmt::format("{},{},{},{}", crop->corner.x, crop->corner.y, crop->size.x, crop->size.y)), imageSize.x,
         imageSize.y);
}

DisplayLook OutputDescription::look() const {
  constexpr Background kDark{.top = {0.028f, 0.031f, 0.038f}, .bottom = {0.007f, 0.008f, 0.01f}};
  DisplayLook look{.exposure = exposure.value_or(0.0), .toneMap = toneMap.value_or(ToneMap::None)};
  if (background)
    look.background = Background{.top = *background, .bottom = *background};
  else if (!transparent)
    look.background = kDark;
  return look;
}

}  // namespace freevoxels
