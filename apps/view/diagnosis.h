#pragma once
// Images that show how an image is made, instead of the volume.

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/image/image.h"
#include "engine/octree/hierarchy_layout.h"
#include "engine/renderer.h"
#include "engine/scene/camera.h"

namespace freevoxels {

/// The linear colour of a level; colours repeat after six levels.
glm::vec3 levelColor(int level);

struct PaintedBlock {
  Block block;
  glm::vec3 color{0.0f};  ///< linear
};

/// An opaque image over black. The blocks belong to a volume of these dimensions.
Image paintBlocks(std::span<const PaintedBlock> blocks, glm::ivec3 dimensions, const glm::dmat4& indexToWorld,
                  const Camera& camera, glm::ivec2 size);

/// The voxels that are in none of the blocks `drawn`: those that were left out.
std::vector<Block> leftOut(std::span<const Block> drawn, std::span<const Block> voxels);

enum class Shown : int {
  Image,
  Energy,         ///< E of every pixel relative to the largest
  Transmittance,  ///< exp(-T) of every pixel
  Blocks,         ///< drawn blocks, coloured by level, and blocks that are left out
  TableSlice,     ///< transmittances towards one direction of the table, in a plane of voxels
  TableImage,   ///< those of the whole volume: Subr et al. 2007, Figure 2
};

struct Diagnosis {
  Shown shown = Shown::Image;
  int direction = 0;   ///< index of a direction of the table
  int axis = 2;        ///< axis across the slice
  double place = 0.5;  ///< position of the slice along the axis, 0..1
  /// The camera for which blocks are chosen, to be viewed from another one.
  std::optional<Camera> chosenFor;
};

/// Makes such images of one volume and renderer at a time.
class Diagnoser {
 public:
  explicit Diagnoser(const Device& device) : device_(device) {}

  /// Forgets the data of the last renderer.
  void reset();
  /// `volume` and `settings` are those of `renderer`; not for Shown::Image.
  Image make(const Diagnosis& diagnosis, Renderer& renderer, const Volume& volume, const TableSettings& table,
             const Camera& camera, const FrameSettings& settings);

 private:
  const std::vector<std::vector<std::uint8_t>>& codes(Renderer& renderer);
  Image drawTable(int direction, Renderer& renderer, const Volume& volume, const TableSettings& table,
                  const Camera& camera, glm::ivec2 size);

  const Device& device_;
  std::vector<std::vector<std::uint8_t>> codes_;
  int tableDirection_ = -1;
  Volume tableVolume_;  ///< the table's transmittances, for tableRenderer_
  std::unique_ptr<Renderer> tableRenderer_;
};

}  // namespace freevoxels
