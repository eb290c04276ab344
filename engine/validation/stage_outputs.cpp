#include "engine/validation/stage_outputs.h"

#include "engine/renderer_stages.h"

namespace freevoxels {

namespace {

class RendererOutputs : public StageOutputs {
 public:
  RendererOutputs(const Device& device, const Volume& volume, const Classification& classification,
                  const TableSettings& table)
      : renderer_(device, volume, classification, table) {}

  std::vector<float> extinction() override { return RendererStages(renderer_).downloadExtinction(); }
  std::vector<glm::dvec3> emission() override { return RendererStages(renderer_).downloadEmission(); }
  TableBytes table() override { return RendererStages(renderer_).downloadTable(); }
  std::vector<std::uint32_t> visibleVoxels() override { return RendererStages(renderer_).downloadBlockList(); }
  RayCodes rays(const RaySource& source) override { return RendererStages(renderer_).downloadRays(source); }
  std::vector<SplatSums> sums(const Camera& camera, const FrameSettings& settings) override {
    return RendererStages(renderer_).renderSums(camera, settings);
  }
  Image image(const Camera& camera, const FrameSettings& settings) override { return renderer_.render(camera, settings); }

 private:
  Renderer renderer_;
};

}  // namespace

StageMaker deviceStages(const Device& device) {
  return [&device](const Volume& volume, const Classification& classification, const TableSettings& table) {
    return std::make_unique<RendererOutputs>(device, volume, classification, table);
  };
}

}  // namespace freevoxels
