#pragma once
// Axial, coronal and sagittal slices of a volume's values, along the axes of its voxels.

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/view/overlays.h"
#include "apps/view/view_state.h"
#include "engine/vulkan/texture.h"

namespace freevoxels {

/// The voxels' axis, y or z, that is nearest to the volume's up direction.
int upAxis(const Volume& volume);

/// The voxels' axes in the slice across `axis`: to the right and upwards.
glm::ivec2 axesAcross(int axis, int up);

/// The bytes of the slice across `axis` at a voxel, RGBA, top row first, one texel a voxel, coloured as drawSlice() does; voxels without
/// data are dark blue.
std::vector<std::uint8_t> sliceTexels(const Volume& volume, const Classification& colors, int axis, int voxel);

/// The letter of the side of a patient (R, L, A, P, I, S) towards which an axis of the voxels, or the opposite direction, points most; 0
/// where the volume's world is not that of a scan: millimetres, towards the left, the back and the head.
char patientSide(const Volume& volume, int axis, bool opposite);

class SliceView {
 public:
  explicit SliceView(const Device& device) : device_(device) {}

  /// Fills the current Dear ImGui window with the three slices through one voxel of the whole volume, clipped or not. The mouse moves that
  /// voxel, the wheel goes from slice to slice, with Ctrl it zooms, a drag with the middle button pans, a double click shows the whole
  /// slice again, and a tooltip has the value under the mouse.
  void draw(const ViewState& state);
  /// The outlines of the slices over the image.
  void drawOutlines(const ViewState& state, const ImageFrame& frame) const;

 private:
  struct Slice {
    int voxel = -1;
    std::unique_ptr<Texture> texture;
    float zoom = 1.0f;
    ImVec2 shift{0.0f, 0.0f};  ///< of the slice's middle from that of its room, in widths and heights of the unzoomed slice
  };
  void follow(const ViewState& state);
  void drawSlice(int axis, ImVec2 size);
  void handle(int axis, const ImageFrame& frame);
  void zoom(Slice& slice, ImVec2 middle, ImVec2 size) const;
  void drawSides(int axis, ImVec2 low, ImVec2 high) const;

  const Device& device_;
  std::shared_ptr<const Volume> volume_;
  std::string colorsText_;  ///< of the classification that `colors_` were made of
  Classification colors_;
  glm::ivec3 voxel_{0};  ///< that all three go through
  std::array<Slice, 3> slices_;
};

}  // namespace freevoxels
