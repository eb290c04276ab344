#pragma once
// What is drawn over the image: axes, the volume's box, scale bar and colour bar.

#include <imgui.h>

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/view/view_state.h"
#include "engine/scene/camera.h"

namespace freevoxels {

/// The image's rectangle in the window.
struct ImageFrame {
  ImVec2 low, high;

  glm::vec2 size() const { return {high.x - low.x, high.y - low.y}; }
  /// The place of a world position; nothing where it is behind the eye.
  std::optional<ImVec2> place(const Camera& camera, glm::dvec3 world) const;
};

/// Room for what is drawn over an image.
class OverlayRoom {
 public:
  /// `gap` is the least distance between two rectangles.
  OverlayRoom(const ImageFrame& frame, float gap) : frame_(frame), gap_(gap) {}
  /// Takes a rectangle. Returns false, and takes nothing, where it is not within the image, where it is wider or higher than half of it,
  /// and where it is too near to one that was taken before.
  bool take(ImVec2 low, ImVec2 high);

 private:
  const ImageFrame frame_;
  const float gap_;
  std::vector<std::pair<ImVec2, ImVec2>> taken_;
};

/// The part of the image between the axes at its lower left and the longest scale bar at its lower right; `high.x` is less than `low.x`
/// where there is nothing between them.
ImageFrame betweenAxesAndScaleBar(const ImageFrame& frame);

/// World length of a pixel at the look-at point, of an image `height` pixels high.
double pixelLength(const Camera& camera, double height);
/// The way in the plane that is parallel to the image and goes through a position before the eye, for a way on an image `height` pixels
/// high, in pixels to the right and upwards.
glm::dvec3 wayBeside(const Camera& camera, glm::dvec3 position, glm::dvec2 pixels, double height);

/// The axis in the corner whose end is under the mouse: 0 to 5 for +x, -x, +y, -y, +z, -z. None where there is no room for the axes.
std::optional<int> axisUnderMouse(const Camera& camera, const ImageFrame& frame);

/// The box that clips the volume, with a handle in the middle of each side; and the plane, with one in its middle.
struct ClipHandles {
  static constexpr int kPlane = 6;
  struct Handle {
    int side = 0;        ///< 0 to 5: the first and last voxel along x, y and z; or kPlane
    ImVec2 place;        ///< in the window
    glm::vec2 step{0.0f};  ///< by which it moves for each voxel, of the plane along its normal
  };
  std::vector<Handle> handles;  ///< those that are before the eye

  /// None where nothing is clipped. `state` has a camera and an image.
  ClipHandles(const ViewState& state, const ImageFrame& frame);
  /// The one under the mouse.
  const Handle* hovered() const;

 private:
  void addBox(const ViewState& state, const ImageFrame& frame);
  void addPlane(const ViewState& state, const ImageFrame& frame);
};

/// The number among the scene's lights of the point light under the mouse. `state` has a camera and an image.
std::optional<std::size_t> lightUnderMouse(const ViewState& state, const ImageFrame& frame);

/// Where a plane cuts the volume's box: the corners of a convex polygon in the world, in order. None where it misses the box.
std::vector<glm::dvec3> planeInBox(const Volume& volume, const ClipPlane& plane);

/// The box with one side moved by a number of voxels, at least one voxel thick and inside of a volume of `dimensions`.
VoxelBox withSideMoved(const VoxelBox& box, int side, int voxels, glm::ivec3 dimensions);

/// Draws what ViewState::overlays has, as far as there is room for it, into the current Dear ImGui window. `state` has a camera.
void drawOverlays(const ViewState& state, const ImageFrame& frame);

}  // namespace freevoxels
