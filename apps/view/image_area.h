#pragma once
// The area of the window that shows the image, moves the camera, and changes window and level.

#include <array>
#include <glm/glm.hpp>

#include "apps/view/overlays.h"
#include "apps/view/view_state.h"
#include "engine/vulkan/texture.h"

namespace freevoxels {

/// The textures of an image; any may be null.
struct ShownTextures {
  const Texture* image = nullptr;
  const Texture* before = nullptr;    ///< the image before, which `image` replaces gradually
  const Texture* compared = nullptr;  ///< shown right of ViewState::split
  float weight = 1.0f;                ///< of `image` over `before`
  bool isOpaque = false;              ///< whether they were made with a background
};

class ImageArea {
 public:
  /// Fills the rest of the current Dear ImGui window.
  void draw(ViewState& state, const ShownTextures& textures);

  /// Size of the area in the last frame, in pixels; 0 before the first.
  glm::ivec2 pixels() const { return pixels_; }
  /// Whether the user is moving the camera.
  bool moves() const { return moves_; }
  /// Whether the user has turned the camera.
  bool hasTurned() const { return turned_; }

 private:
  enum class Held { Nothing, Camera, Split, Axes, Clip, Light };
  void press(ViewState& state, const ShownTextures& textures, const ImageFrame& frame);
  void drag(ViewState& state, const ImageFrame& frame);
  void dragClip(ViewState& state) const;
  void dragLight(ViewState& state, const ImageFrame& frame) const;
  void fly(ViewState& state);

  glm::ivec2 pixels_{0};
  Held held_ = Held::Nothing;
  struct {
    int side = 0;
    glm::vec2 step{0.0f}, mouse{0.0f};
    std::optional<VoxelBox> box;
    std::optional<ClipPlane> plane;
  } clip_;  ///< the handle that is held, as it was when it was taken
  struct {
    std::size_t number = 0;
    glm::dvec3 place{0.0};
    glm::dvec2 mouse{0.0};
  } light_;                      ///< the light that is held, as it was when it was taken
  std::array<bool, 6> flies_{};  ///< for each of the keys right, left, up, down, on and back
  bool moves_ = false, turned_ = false;
};

/// The camera that frames the visible part of the volume.
Camera framedVolume(const ViewState& state);

}  // namespace freevoxels
