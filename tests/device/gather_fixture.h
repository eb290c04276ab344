#pragma once
// Scenes and settings of the tests of gathered frames.

#include <vector>

#include "engine/reference/oracle.h"
#include "engine/volume/subject.h"
#include "tests/device/splat_fixture.h"

namespace freevoxels {

class GatherTest : public SplatTest {
 protected:
  static FrameSettings gathering(glm::ivec2 size) { return {.size = size, .lod = 0.0f}; }
  /// Looks along -z at the volume's middle with this many pixels a voxel.
  static Camera alongZ(const Volume& volume, glm::ivec2 size, double pixelsPerVoxel) {
    Camera camera;
    camera.lookAt = glm::dvec3(volume.indexToWorld * glm::dvec4(0.5 * glm::dvec3(volume.dimensions - 1), 1.0));
    camera.position = camera.lookAt + glm::dvec3(0.0, 0.0, 10.0);
    camera.orthographic = true;
    camera.orthographicHeight = size.y / pixelsPerVoxel * glm::length(glm::dvec3(volume.indexToWorld[1]));
    return camera;
  }
  struct Scene {
    Volume volume;
    Classification classification;
  };
  static Scene cloud(int resolution) {
    Scene scene{.volume = makeProcedural("cloud", resolution), .classification = {}};
    scene.classification.densityScale = automaticDensityScale(scene.volume, 2.0);
    return scene;
  }
  /// PSNR to the oracle of frames that differ only in how they are drawn.
  static std::vector<double> qualitiesOf(const Scene& scene, const Camera& camera, const std::vector<FrameSettings>& frames) {
    Renderer renderer(device(), scene.volume, scene.classification, {});
    const Oracle oracle = renderOracle(scene.volume, scene.classification, camera,
                                       {.size = frames.front().size, .tolerance = 4e-3, .lighting = frames.front().lighting});
    std::vector<double> result;
    for (const FrameSettings& settings : frames) result.push_back(psnr(renderer.render(camera, settings), oracle.image));
    return result;
  }
  static double qualityOf(const Scene& scene, const Camera& camera, const FrameSettings& settings) {
    return qualitiesOf(scene, camera, {settings}).front();
  }
  /// PSNR to the oracle, of level of detail 1.
  static std::vector<double> qualities(const Scene& scene, const std::vector<Camera>& cameras, int pixels) {
    Renderer renderer(device(), scene.volume, scene.classification, {});
    FrameSettings settings = gathering(glm::ivec2(pixels));
    settings.lod = 1.0f;
    std::vector<double> result;
    for (const Camera& camera : cameras) {
      const Oracle oracle = renderOracle(scene.volume, scene.classification, camera, {.size = settings.size, .tolerance = 4e-3});
      result.push_back(psnr(renderer.render(camera, settings), oracle.image));
    }
    return result;
  }
};

}  // namespace freevoxels
