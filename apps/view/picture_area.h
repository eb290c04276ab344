#pragma once
// The part of the window that shows the picture, and takes the hands that move the camera.

#include <glm/glm.hpp>

#include "apps/view/view_state.h"
#include "engine/vulkan/texture.h"

namespace freevoxels {

class PictureArea {
 public:
  /// Fills what is left of the current Dear ImGui window; right of ViewState::split with `compared`. Both may
  /// be null.
  void draw(ViewState& state, const Texture* texture, const Texture* compared);

  /// Of the area in the last frame, in pixels; 0 before.
  glm::ivec2 pixels() const { return pixels_; }
  /// Whether a hand is on the camera.
  bool moves() const { return moves_; }

 private:
  void drag(ViewState& state, glm::vec2 size);
  void fly(ViewState& state);
  void keys(ViewState& state) const;

  glm::ivec2 pixels_{0};
  bool moves_ = false, splits_ = false;  ///< a hand is on the camera, or on the split
};

}  // namespace freevoxels
