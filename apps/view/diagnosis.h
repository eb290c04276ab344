#pragma once
// Images that show how an image is made, instead of the volume.

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "engine/renderer.h"

namespace freevoxels {

enum class Shown : int {
  Picture,
  Energy,         ///< E of every pixel relative to the largest
  Transmittance,  ///< exp(-T) of every pixel
  Blocks,         ///< drawn blocks, coloured by level, and blocks that are left out
  TableSlice,     ///< transmittances towards one direction of the table, in a plane of voxels
  TablePicture,   ///< those of the whole volume: Subr et al. 2007, Figure 2
};

struct Diagnosis {
  Shown shown = Shown::Picture;
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
  /// `volume` and `settings` are those of `renderer`; not for Shown::Picture.
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
