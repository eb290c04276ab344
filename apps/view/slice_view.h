#pragma once
// Axial, coronal and sagittal slices of a volume's values.

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "apps/view/overlays.h"
#include "apps/view/view_state.h"
#include "engine/vulkan/texture.h"

namespace freevoxels {

/// The voxels' axis, y or z, that is nearest to the volume's up direction.
int upAxis(const Volume& volume);

/// The axes of the slice across `axis`: to the right and upwards.
glm::ivec2 sliceAxes(int axis, int up);

/// The bytes of the slice across `axis` at a voxel, RGBA, top row first, one texel a voxel: values from range.x to range.y are
/// black to white, voxels without data dark blue.
std::vector<std::uint8_t> sliceTexels(const Volume& volume, int axis, int voxel, glm::dvec2 range);

class SliceView {
 public:
  explicit SliceView(const Device& device) : device_(device) {}

  /// Fills the current Dear ImGui window with the three slices through one voxel. The mouse moves that voxel, the wheel goes from
  /// slice to slice, and a tooltip has the value under the mouse.
  void draw(const ViewState& state);
  /// The outlines of the slices over the image.
  void drawOutlines(const ViewState& state, const ImageFrame& frame) const;

 private:
  struct Slice {
    int voxel = -1;
    glm::dvec2 range{0.0};
    std::unique_ptr<Texture> texture;
  };
  void follow(const ViewState& state);
  void drawSlice(int axis, ImVec2 size, glm::dvec2 range);
  void handle(int axis, const ImageFrame& frame);

  const Device& device_;
  std::shared_ptr<const Volume> volume_;
  glm::ivec3 voxel_{0};  ///< that all three go through
  std::array<Slice, 3> slices_;
};

}  // namespace freevoxels
