#pragma once
// Volumes of measured values, such as CT and MR scans, and a transfer function for a first look at one.

#include "engine/volume/classification.h"

namespace freevoxels {

/// Whether scalars are measurements rather than densities: more than 1 % of the active voxels are negative, or at least 95 % of
/// the box's voxels are active, of more than one value. Level sets, which are read as densities, are none.
bool looksLikeScan(const Volume& volume);

/// Makes +z the up direction of a volume that looks like a scan, whose slices mostly are stacked along the patient's axis.
void orientScan(Volume& volume);

/// Four classes of values, told apart by their histogram (Otsu's method with several thresholds, Liao, Chen and Chung 2001, on
/// square roots of counts, so that small parts count). The class of most values on the box's sides is transparent, or the lowest
/// where none has half of them; the farther another class is from it, the more opaque it is.
TransferFunction scanTransferFunction(const Volume& volume);

}  // namespace freevoxels
