#pragma once
// The options of classification: physical, or a transfer function.

#include <optional>
#include <string>
#include <vector>

#include "apps/freevoxels/option_values.h"
#include "engine/volume/classification.h"

namespace freevoxels {

/// In the order of ClassificationOrder.
inline const std::vector<std::string> kOrderWords{"post", "pre"};

struct ClassificationOptions {
  std::optional<double> densityScale;
  std::optional<glm::dvec3> albedo;
  std::optional<std::string> transferFunction;
  std::optional<std::string> albedoGrid;
  std::optional<int> order;  ///< ClassificationOrder

  void add(CLI::App& app);
  /// Reads the transfer function. What is not given is as the volume's file says, if it does (Volume::classification); options are
  /// refused with ErrorKind::Usage where that is fixed. Otherwise, without options scans have scanTransferFunction, level sets are opaque, and others have the
  /// automatic density scale of volumes that shine, or do not.
  Classification resolve(const Volume& volume, bool shines) const;
  /// Takes the place of what is not given: what was resolved for another volume.
  void take(const Classification& resolved);
  void describe(OptionList& options, const Volume& volume, const Classification& resolved) const;
};

}  // namespace freevoxels
