#pragma once
// Volumes with their colours and views, for measuring image quality.

#include <array>
#include <span>
#include <string>

#include "engine/scene/camera.h"
#include "engine/volume/classification.h"
#include "engine/volume/volume.h"

namespace freevoxels {

enum class QualityColor {
  Bone,   ///< apps/transfer_functions/bone.json
  Cloud,  ///< apps/transfer_functions/cloud.json
  Skin,   ///< opaque within one or two voxels, from the head's skin inwards
};
TransferFunction qualityTransferFunction(QualityColor color, const Volume& volume);

struct QualitySubject {
  const char* procedural;
  QualityColor color;
  bool thin;  ///< whether it has structures of the size of a voxel, for which less quality is expected
};
inline constexpr std::array<QualitySubject, 4> kQualitySubjects{{{"head", QualityColor::Bone, false},
                                                                 {"shells", QualityColor::Cloud, false},
                                                                 {"cloud", QualityColor::Cloud, false},
                                                                 {"rods", QualityColor::Cloud, true}}};

struct QualityScene {
  std::string name;  ///< "head at 64^3"
  Volume volume;
  Classification classification;
  bool thin = false;
  int resolution = 0;  ///< voxels along an edge of the volume before it is cropped
};

/// Crops `volume`, which was made with `resolution`³ voxels, to its active voxels. The medium is the same for
/// every resolution: opacities of the transfer function refer to a 64th of the edge.
QualityScene makeQualityScene(const QualitySubject& subject, int resolution, Volume volume);

/// Angles in degrees, as for framingCamera.
struct QualityView {
  double azimuth = kDefaultAzimuth, elevation = kDefaultElevation;
  double verticalFov = 35.0;
};
/// Twelve views: along axes, at edges, at a corner, oblique, between lattice directions, and close.
std::span<const QualityView> qualityViews();
/// Fewer views of the same kinds.
std::span<const QualityView> quickQualityViews();

/// "(35, 25)", with the field of view if it is not the default.
std::string viewText(const QualityView& view);
/// The camera of a view, for a square image.
Camera viewCamera(const Volume& volume, const QualityView& view);

}  // namespace freevoxels
