#pragma once
// Volumes of measured values, such as CT and MR scans, and a default transfer function for them.

#include "engine/scene/render_settings.h"
#include "engine/volume/classification.h"
#include "engine/volume/transfer_curves.h"

namespace freevoxels {

/// Whether the scalars are measurements rather than densities: more than 1 % of the active voxels are
/// negative, or at least 95 % of the box's voxels are active and have more than one value, where the file does not say that they are
/// densities (Volume::isFog). Level sets are not scans, since they are read as densities.
bool looksLikeScan(const Volume& volume);

/// What of a volume's values means that a voxel holds no data.
struct NoData {
  std::optional<double> value;  ///< nothing: every number is data

  /// The value as voxels have it.
  std::optional<float> scalar() const { return value ? std::optional(float(*value)) : std::nullopt; }
  bool operator==(const NoData&) const = default;
};

/// The value with which a scan is filled up to a box around what was measured: the smallest or largest value, which a tenth of the
/// voxels on the box's sides have exactly, and which is far from all others. Farther than these are from each other, it cannot be data;
/// three tenths of that, or half the distance from the other end to their median, are enough where other values reach the sides, too. 0 is
/// not taken for padding, since it may be air, nor anything in a volume of labels, which has few different values.
std::optional<float> paddingOf(const Volume& volume);
/// The remark (Volume::remarks) that the padding holds no data.
std::string paddingRemark(float padding);
/// To be called after summariseValues() has removed the voxels that have the value of `noData`, which becomes the padding of a scan. Without
/// `noData` it looks for padding, removes it and adds a remark.
void settleNoData(Volume& volume, const std::optional<NoData>& noData);

/// Whether an array is of densities that were cut out of nothing, as no file says of it: values from 0 to 10, not all of them whole, of
/// which nine tenths on the sides of the box are exactly 0.
bool looksLikeFog(const Volume& volume);

/// Sets the up direction of a volume that looks like a scan to +z: slices are mostly stacked along the
/// patient's axis.
void orientScan(Volume& volume);

/// The values between which all but one in 2000 at either end are; from 0 on if the volume is no scan and has no value below.
ValueWindow usualRange(const Volume& volume);

/// A transfer function for four classes of values, which are found by the histogram (Otsu's method with
/// several thresholds, Liao, Chen and Chung 2001, on square roots of counts, so that small parts count). The
/// class that most voxels on the box's sides belong to is transparent, or the lowest class if none has half
/// of them. The farther a class is from it, the more opaque it is.
TransferFunction scanTransferFunction(const Volume& volume);

/// White, of an opacity with which values over black look evenly graded on a display (sRGB). The largest values along rays (Maximum) are
/// graded from the smallest value or 0 to the largest value; of a scan from where scanTransferFunction() begins to be opaque to the largest
/// value but outliers. Means of a scan are smaller: from the smallest value to the mean of those that are not transparent.
TransferFunction intensityFunction(const Volume& volume, IntensityProjection projection);

/// A surface in front of all values from this one on.
struct IsoSurface {
  double value = 0.0;
  glm::dvec3 color{0.8};  ///< linear Rec.709, 0..1

  bool operator==(const IsoSurface&) const = default;
};

/// Whether a transfer function draws the air around what was scanned: nearly all values on the box's sides are of the lowest class, of
/// which scanTransferFunction() draws nothing.
bool drawsAir(const Volume& volume, const TransferFunction& function);

/// Opaque within a hundredth of a voxel from the surface's value on.
TransferFunction isoFunction(const IsoSurface& surface, const Volume& volume);

}  // namespace freevoxels
