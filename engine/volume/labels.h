#pragma once
// Volumes of labels (segmentations, masks): whole numbers, of which each stands for a part. They are drawn as solids of these parts, and
// labels are never interpolated: between the labels 2 and 4 there is no 3.

#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <optional>

#include "engine/volume/volume.h"

namespace freevoxels {

struct LabelStyle {
  std::optional<glm::vec3> color;  ///< linear Rec.709, 0..1; else that of automaticLabelColor()
  float opacity = 1.0f;            ///< of a voxel, 0..1; 1 is that of the optical depth kSolidOpticalDepth

  bool operator==(const LabelStyle&) const = default;
};

/// Which labels are drawn, and how. The label 0 is no part.
struct Labels {
  bool showsAll = true;  ///< also those that have no style
  std::map<std::int64_t, LabelStyle> styles;

  /// Whether no label is drawn at all: the values are no labels, but scalars.
  bool isNone() const { return !showsAll && styles.empty(); }
  bool shows(std::int64_t label) const { return label != 0 && (showsAll || styles.contains(label)); }

  bool operator==(const Labels&) const = default;
};

/// How the values of a grid are drawn where they are labels.
struct LabelRequest {
  Labels labels{.showsAll = false, .styles = {}};  ///< Labels::isNone(): all values are scalars
  bool ofAllGrids = false;                         ///< whether real numbers are labels, too, and not only whole numbers, booleans and masks

  /// The labels of a grid of whole numbers or of others; null where its values are scalars.
  const Labels* of(bool isWhole) const { return !labels.isNone() && (isWhole || ofAllGrids) ? &labels : nullptr; }
};

inline constexpr const char* kNoLabelClause = "none of its voxels has a label that is shown";

/// Colours of labels that follow each other are far apart.
glm::vec3 automaticLabelColor(std::int64_t label);

/// The label of a scalar: the nearest whole number. Single precision holds whole numbers up to 2^24 exactly.
std::int64_t labelOf(float scalar);

/// Turns scalars that are labels into densities and an albedo grid, and fills the counts and ranges of the volume. A density of 1 has the
/// optical depth kSolidOpticalDepth a voxel. Labels that are not shown hold no data. Densities are means over 5^3 voxels, so that surfaces
/// have no steps, and reach two voxels beyond the labels; colours are those of the nearest label.
void showLabels(Volume& volume, const Labels& labels);

}  // namespace freevoxels
