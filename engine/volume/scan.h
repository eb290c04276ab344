#pragma once
// Volumes of measured values, such as CT and MR scans, and a default transfer function for them.

#include "engine/volume/classification.h"

namespace freevoxels {

/// Whether the scalars are measurements rather than densities: more than 1 % of the active voxels are
/// negative, or at least 95 % of the box's voxels are active and have more than one value. Level sets are not
/// scans, since they are read as densities.
bool looksLikeScan(const Volume& volume);

/// Sets the up direction of a volume that looks like a scan to +z: slices are mostly stacked along the
/// patient's axis.
void orientScan(Volume& volume);

/// A transfer function for four classes of values, which are found by the histogram (Otsu's method with
/// several thresholds, Liao, Chen and Chung 2001, on square roots of counts, so that small parts count). The
/// class that most voxels on the box's sides belong to is transparent, or the lowest class if none has half
/// of them. The farther a class is from it, the more opaque it is.
TransferFunction scanTransferFunction(const Volume& volume);

}  // namespace freevoxels
