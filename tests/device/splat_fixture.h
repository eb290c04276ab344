#pragma once
// Images on the device against the double-precision reference.

#include <algorithm>
#include <cmath>

#include "engine/lighting/scattering_solver.h"
#include "engine/reference/reference_scattering.h"
#include "engine/reference/reference_splats.h"
#include "engine/reference/reference_table.h"
#include "engine/renderer.h"
#include "tests/device/device_fixture.h"
#include "tests/device/test_volumes.h"

namespace freevoxels {

class SplatTest : public DeviceTest {
 protected:
  static Image reference(const Volume& volume, const Classification& classification,
                         const TableSettings& table, const Camera& camera, const FrameSettings& settings) {
    const auto extinction = referenceExtinction(volume, classification);
    const auto bytes = referenceTable(volume, extinction, table);
    std::optional<ScatteredField> scattered;
    const ScatteringMedium medium(volume, classification);
    if (settings.lighting && hasScatteredLight(*settings.lighting, medium.emits()))
      scattered = referenceScattering(medium, *settings.lighting);
    const auto sums = referenceSplatSums(
        volume, classification,
        {.extinction = extinction, .table = bytes, .tableSettings = table, .scattered = scattered ? &*scattered : nullptr}, camera,
        settings, referenceVisibleVoxels(extinction));
    return referenceResolve(sums, settings);
  }

  /// The table may be one code off here and there (its own test), which moves a colour by up to 1e-2 where
  /// few voxels mix; alpha does not use the table.
  void expectSameImage(const Volume& volume, const Camera& camera, FrameSettings settings, const TableSettings& table = {},
                       float opacity = 0.5f) {
    const Classification classification = coloured(volume, opacity);
    settings.depth = true;
    Renderer renderer(device(), volume, classification, table);
    const Image image = renderer.render(camera, settings);
    const Image expected = reference(volume, classification, table, camera, settings);
    double worstColor = 0.0, worstAlpha = 0.0;
    for (std::size_t i = 0; i < expected.pixels.size(); ++i) {
      const glm::dvec4 difference = glm::abs(glm::dvec4(image.pixels[i]) - glm::dvec4(expected.pixels[i]));
      worstColor = std::max({worstColor, difference.x, difference.y, difference.z});
      worstAlpha = std::max(worstAlpha, difference.w);
    }
    const bool normalised = settings.isNormalised();
    EXPECT_LE(worstColor, 5e-3);
    EXPECT_LE(worstAlpha, normalised ? 1e-4 : 5e-3);
    EXPECT_LE(worstRelativeDepth(image, expected), 2e-3);
    EXPECT_GE(psnr(image, expected), 65.0);
  }

  static constexpr glm::ivec3 kSize{11, 14, 9};
  static Volume volume(bool sheared) {
    return randomVolume(kSize, sheared ? shearedTransform(kSize) : cubeTransform(kSize), 0.6, 1.0);
  }
};

}  // namespace freevoxels
