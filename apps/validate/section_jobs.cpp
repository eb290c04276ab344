#include "apps/validate/section_jobs.h"

#include <fmt/format.h>

#include <array>
#include <memory>

#include "apps/freevoxels/input_options.h"
#include "engine/renderer.h"
#include "engine/validation/closed_forms.h"
#include "engine/validation/invariances.h"
#include "engine/validation/stage_checks.h"
#include "engine/volume/vdb.h"

namespace freevoxels::validate {

namespace {

constexpr int kQuickFileEdge = 40, kWholeFileEdge = 128;
constexpr int kQuickPicture = 80, kWholePicture = 144;
constexpr int kQuickCube = 40, kWholeCube = 64;

struct ProceduralScene {
  const char* name;
  SceneColor color;
};
constexpr std::array<ProceduralScene, 6> kProcedural{{{"cube", SceneColor::Density},
                                                      {"cloud", SceneColor::TransferFunction},
                                                      {"marschner-lobb", SceneColor::Density},
                                                      {"shells", SceneColor::TransferFunction},
                                                      {"rods", SceneColor::Density},
                                                      {"head", SceneColor::TransferFunction}}};

/// `makeScene` is called when the job runs: a scene is in memory no longer than it is needed.
template <typename MakeScene>
void addScene(std::vector<SectionJob>& jobs, const Device& device, const std::string& name,
              glm::ivec2 picture, const MakeScene& makeScene) {
  jobs.push_back({fmt::format("stages of {}", name),
                  [=, &device] { return stageChecks(deviceStages(device), makeScene(), picture); }});
  jobs.push_back({fmt::format("invariances of {}", name),
                  [=, &device] { return invariances(device, makeScene(), picture); }});
}

std::vector<int> resolutions(const Extent& extent) {
  if (extent.resolution) return {*extent.resolution};
  return extent.quick ? std::vector{32} : std::vector{64, 128};
}

}  // namespace

std::vector<SectionJob> planSections(const Device& device, const Extent& extent) {
  const glm::ivec2 picture(extent.quick ? kQuickPicture : kWholePicture);
  const int cube = extent.quick ? kQuickCube : kWholeCube;
  std::vector<SectionJob> jobs;
  jobs.push_back({"closed forms", [&device, cube] { return closedForms(deviceStages(device), cube); }});
  for (const int resolution : resolutions(extent))
    for (const ProceduralScene& scene : kProcedural)
      addScene(jobs, device, fmt::format("{} at {}^3", scene.name, resolution), picture,
               [resolution, &scene, &device] {
                 return makeValidationScene(openProcedural(scene.name, resolution,
                                                           maximumVoxels(device, DirectionSet::Directions98)),
                                            scene.color, resolution);
               });
  for (const std::string& file : extent.files) {
    const auto scene = std::make_shared<ValidationScene>(
        makeValidationScene(readVdb(file, "", maximumVoxels(device, DirectionSet::Directions98)),
                            SceneColor::Density, extent.quick ? kQuickFileEdge : kWholeFileEdge));
    addScene(jobs, device, file, picture, [scene] { return *scene; });
  }
  return jobs;
}

}  // namespace freevoxels::validate
