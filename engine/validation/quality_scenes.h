#pragma once
// Volumes with their colours, and the views of them, on which picture quality is measured.

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
  bool thin;  ///< parts of the size of a voxel: less is expected of its pictures
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
  int resolution = 0;  ///< voxels along an edge of the volume, before it was cropped
};

/// `volume`, made of `resolution`³ voxels, is cropped to its active voxels. Its medium is the same at every
/// resolution: opacities of the transfer function are of a 64th of the edge.
QualityScene makeQualityScene(const QualitySubject& subject, int resolution, Volume volume);

/// In degrees, as for framingCamera.
struct QualityView {
  double azimuth = kDefaultAzimuth, elevation = kDefaultElevation;
  double verticalFov = 35.0;
};
/// Along axes, at edges, at a corner, oblique, between lattice directions, and one with the eye close.
std::span<const QualityView> qualityViews();
/// Fewer, of the same kinds.
std::span<const QualityView> quickQualityViews();

/// "(35, 25)", with the field of view where it is not the usual.
std::string viewText(const QualityView& view);
/// Of a square picture.
Camera viewCamera(const Volume& volume, const QualityView& view);

}  // namespace freevoxels
