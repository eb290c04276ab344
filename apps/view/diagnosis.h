#pragma once
// What a picture can show instead of the volume: how it was made.

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "engine/renderer.h"

namespace freevoxels {

enum class Shown : int {
  Picture,
  Energy,         ///< E of every pixel over the largest
  Transmittance,  ///< exp(-T) of every pixel
  Blocks,         ///< what is drawn, coloured by level, and what is left out
  TableSlice,     ///< transmittances towards one direction of the table, in a plane of voxels
  TablePicture,   ///< the same of the whole volume: Subr et al. 2007, Figure 2
};

struct Diagnosis {
  Shown shown = Shown::Picture;
  int direction = 0;   ///< of the table's
  int axis = 2;        ///< that the slice is across
  double place = 0.5;  ///< of the slice along it, 0..1
  /// The camera that blocks were chosen for, to be looked at from another.
  std::optional<Camera> chosenFor;
};

/// Makes such pictures of one volume and renderer at a time.
class Diagnoser {
 public:
  explicit Diagnoser(const Device& device) : device_(device) {}

  /// Forgets what was kept of the last renderer.
  void reset();
  /// `volume` and `settings` are what `renderer` draws; not Shown::Picture.
  Image make(const Diagnosis& diagnosis, Renderer& renderer, const Volume& volume, const TableSettings& table,
             const Camera& camera, const FrameSettings& settings);

 private:
  const std::vector<std::vector<std::uint8_t>>& codes(Renderer& renderer);
  Image drawTable(int direction, Renderer& renderer, const Volume& volume, const TableSettings& table,
                  const Camera& camera, glm::ivec2 size);

  const Device& device_;
  std::vector<std::vector<std::uint8_t>> codes_;
  int tableDirection_ = -1;
  Volume tableVolume_;  ///< the table's transmittances; of tableRenderer_
  std::unique_ptr<Renderer> tableRenderer_;
};

}  // namespace freevoxels
