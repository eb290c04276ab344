#pragma once
// The part of a volume that an image is to show: its box, or the visible part.

#include "engine/scene/camera.h"
#include "engine/scene/orbit.h"
#include "engine/volume/classification.h"
#include "engine/volume/coarse_cells.h"

namespace freevoxels {

/// The corners of the volume's box, faces of the outermost voxels included.
Subject boxOf(const Volume& volume);

/// A camera that shows the volume's box (scene/camera.h).
inline Camera framingCamera(const Volume& volume, double azimuth, double elevation, double aspect, const Camera& base) {
  return framingCamera(boxOf(volume), azimuth, elevation, aspect, base);
}

/// Cameras of a turntable that show the volume's box (scene/orbit.h).
inline std::vector<Camera> framingOrbit(const Volume& volume, double azimuth, double elevation, int frames, double aspect,
                                        const Camera& base) {
  return framingOrbit(boxOf(volume), azimuth, elevation, frames, aspect, base);
}

/// The parts of a volume that are seen, in cells of about 1/64 of its longest side: those with extinction or emission, but for
/// densities below 1/256 of the largest.
struct ContentCells {
  Cells cells;       ///< 1 where something is seen
  double edge = 1.0;  ///< of a cell, voxels
};
ContentCells contentCells(const Volume& volume, const Classification& classification);
/// The same of a volume of `dimensions`, found in a sample of its voxels at equal distances.
ContentCells contentCellsOf(glm::ivec3 dimensions, const Volume& sample, const Classification& classification);

/// The cells in which something is seen; the whole box where there are none. Of `volume` the box is read, not the values.
Subject subjectOf(const ContentCells& content, const Volume& volume);

/// Whether what is seen of a volume is what its file says, as its classification is that of the file or differs in density alone.
bool isAsBaked(const Volume& volume, const Classification& classification);

/// What is seen of a volume: what its file says where it is as baked, otherwise what the volume's own cells hold.
Subject contentOf(const Volume& volume, const Classification& classification);

}  // namespace freevoxels
