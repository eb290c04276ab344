#pragma once
// The values of voxels that rays towards a light look up.

#include <cstdint>
#include <optional>

#include "engine/volume/classification.h"
#include "engine/volume/transfer_table.h"
#include "engine/volume/volume.h"
#include "shaders/gather_interface.h"

namespace freevoxels {

/// Extinctions per world unit; or scalars in intervals of the transfer function's table, where voxels are classified after interpolation.
class VoxelValues {
 public:
  /// `classification` must outlive this.
  VoxelValues(const Volume& outline, const Classification& classification) : classification_(classification) {
    if (classification.isPost(outline)) table_.emplace(*classification.transferFunction, outline.minimum, outline.maximum);
  }
  bool areScalars() const { return table_.has_value(); }
  float outside() const { return areScalars() ? -1.0f : 0.0f; }
  const TransferTable& table() const { return *table_; }
  float at(float scalar) const {
    if (!areScalars()) return float(classify(classification_, scalar).extinction);
    const std::uint16_t code = table_->code(scalar);
    return code == 0 ? -1.0f : (float(code) - 1.0f) * (float(shader::kTransferIntervals) / float(shader::kScalarCodes));
  }

 private:
  const Classification& classification_;
  std::optional<TransferTable> table_;
};

}  // namespace freevoxels
