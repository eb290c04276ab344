#include "apps/freevoxels/classification_options.h"

#include <CLI/CLI.hpp>

#include "engine/core/error.h"
#include "engine/volume/scan.h"

namespace freevoxels {

namespace {

/// What a baked volume was baked with, changed by the options.
Classification bakedClassification(const ClassificationOptions& options, const Volume& volume) {
  if (options.albedoGrid)
    fail(ErrorKind::Usage, "--albedo-grid chooses among the grids of an OpenVDB file, and {} is a baked volume: give it to 'freevoxels bake'",
         volume.source);
  Classification classification = *volume.classification;
  const bool given = options.densityScale || options.albedo || options.transferFunction || options.order;
  if (given && volume.classificationIsFixed)
    fail(ErrorKind::Usage,
         "{} was baked for one classification, which --density-scale, --albedo, --transfer-function and --classification cannot "
         "change: leave them out, or bake it with --keep-scalars",
         volume.source);
  if (options.densityScale || options.albedo) classification.transferFunction.reset();
  if (options.densityScale) classification.densityScale = *options.densityScale;
  if (options.albedo) classification.albedo = glm::vec3(*options.albedo);
  if (options.order) classification.order = ClassificationOrder(*options.order);
  return classification;
}

}  // namespace

void ClassificationOptions::add(CLI::App& app) {
  CLI::Option* scale =
      addNumber(
          app, "--density-scale", "S", densityScale,
          "Extinction per world unit at density 1 [chosen so that the volume's mean optical depth suits an image; level sets are opaque]",
          {.minimum = 0.0})
          ->group("Classification");
  CLI::Option* color =
      addTriple(app, "--albedo", "R,G,B", albedo,
                "Colour of the volume, linear [0.9,0.9,0.9; with --emission 0.5,0.5,0.5]", {0.0, 1.0})
          ->group("Classification");
  CLI::Option* grid =
      addText(app, "--albedo-grid", "NAME", albedoGrid, "Grid of vectors of the file with the colours, linear, 0..1")
          ->group("Classification");
  addText(app, "--transfer-function", "FILE.json", transferFunction,
          "Colour and opacity by scalar, instead of the above: a file, or JSON that begins with { [for scans one made from the "
          "histogram]")
      ->excludes(scale)
      ->excludes(color)
      ->excludes(grid)
      ->group("Classification");
  addWord(app, "--classification", kOrderWords, order,
          "What a transfer function is applied to: interpolated scalars (post), or voxels (pre), as always for splats and volumes "
          "with emission [post]")
      ->group("Classification");
}

Classification ClassificationOptions::resolve(const Volume& volume, bool shines) const {
  Classification classification;
  if (volume.classification) classification = bakedClassification(*this, volume);
  if (transferFunction) {
    classification.transferFunction = isInlineJson(*transferFunction)
                                          ? parseTransferFunction(*transferFunction, volume)
                                          : readTransferFunction(*transferFunction, volume);
    classification.order = ClassificationOrder(order.value_or(0));
    return classification;
  }
  if (volume.classification) return classification;
  if (!densityScale && !albedo && !albedoGrid && !shines && looksLikeScan(volume)) {
    classification.transferFunction = scanTransferFunction(volume);
    classification.order = ClassificationOrder(order.value_or(0));
    return classification;
  }
  if (densityScale)
    classification.densityScale = *densityScale;
  else if (volume.isLevelSet)
    classification.densityScale = kLevelSetOpticalDepth / volume.voxelSize();
  else
    classification.densityScale = automaticDensityScale(volume, shines ? kShiningOpticalDepth : kAutomaticOpticalDepth);
  if (albedo) classification.albedo = glm::vec3(*albedo);
  return classification;
}

void ClassificationOptions::take(const Classification& resolved) {
  if (!resolved.transferFunction) {
    densityScale = resolved.densityScale;
    return;
  }
  transferFunction = transferFunctionJson(*resolved.transferFunction);  // with its range, which a file may leave to the volume
  order = int(resolved.order);
}

void ClassificationOptions::describe(OptionList& options, const Volume& volume, const Classification& resolved) const {
  if (volume.classificationIsFixed) return;
  if (resolved.transferFunction) {
    options.emplace_back("--transfer-function",
                         transferFunction ? *transferFunction : transferFunctionJson(*resolved.transferFunction));
    options.emplace_back("--classification", kOrderWords[std::size_t(resolved.order)]);
    return;
  }
  options.emplace_back("--density-scale", numberText(resolved.densityScale));
  options.emplace_back("--albedo",
                       fmt::format("{},{},{}", resolved.albedo.x, resolved.albedo.y, resolved.albedo.z));
  if (albedoGrid) options.emplace_back("--albedo-grid", *albedoGrid);
}

}  // namespace freevoxels
