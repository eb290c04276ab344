#pragma once
// The area of the window that shows the image and moves the camera.

#include <glm/glm.hpp>

#include "apps/view/view_state.h"
#include "engine/vulkan/texture.h"

namespace freevoxels {

class PictureArea {
 public:
  /// Fills the rest of the current Dear ImGui window; right of ViewState::split with `compared`. Both may be
  /// null.
  void draw(ViewState& state, const Texture* texture, const Texture* compared);

  /// Size of the area in the last frame, in pixels; 0 before the first.
  glm::ivec2 pixels() const { return pixels_; }
  /// Whether the user is moving the camera.
  bool moves() const { return moves_; }

 private:
  void drag(ViewState& state, glm::vec2 size);
  void fly(ViewState& state);
  void keys(ViewState& state) const;

  glm::ivec2 pixels_{0};
  bool moves_ = false, splits_ = false;  ///< whether the user is moving the camera, or the split
};

}  // namespace freevoxels
