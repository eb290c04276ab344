#include "apps/validate/section_jobs.h"

#include <fmt/format.h>

#include <array>
#include <memory>
#include <span>

#include "engine/description/scene_description.h"
#include "engine/core/error.h"
#include "engine/memory_planner.h"
#include "engine/renderer.h"
#include "engine/validation/closed_forms.h"
#include "engine/validation/cluster_scaling.h"
#include "engine/validation/culling_checks.h"
#include "engine/validation/detail_quality.h"
#include "engine/validation/emission_checks.h"
#include "engine/validation/fly_through_quality.h"
#include "engine/validation/gather_checks.h"
#include "engine/validation/invariances.h"
#include "engine/validation/leakage.h"
#include "engine/validation/level_checks.h"
#include "engine/validation/light_checks.h"
#include "engine/validation/paper_figures.h"
#include "engine/validation/quality.h"
#include "engine/validation/stage_checks.h"
#include "engine/volume/vdb.h"

namespace freevoxels::validate {

namespace {

constexpr int kQuickFileEdge = 40, kWholeFileEdge = 128;
constexpr int kQuickProcedural = 32, kMedium = 64, kLarge = 128;  ///< voxels along an edge
constexpr int kQuickImage = 80, kWholeImage = 96;
constexpr int kQuickCube = 40, kWholeCube = 64;
constexpr int kQuickQuality = 48;  ///< voxels along an edge for comparisons with the oracle
constexpr int kQuickQualityImage = 96, kWholeQualityImage = 160, kLargeQualityImage = 256;
/// Least resolution with goals: in coarser volumes structures have the size of a voxel.
constexpr int kMinResolutionWithGoals = kLarge;
constexpr int kQuickLightImage = 48;
constexpr glm::ivec2 kGatherLightImage{24, 20}, kGatherScalarLightImage{16, 12};
constexpr int kQuickSky = 24;  ///< voxels along an edge for skies, for which the oracle is slow
constexpr int kDetailResolution = kMedium;
constexpr int kTurntableResolution = kMedium, kTurntableFrames = 36, kTurntableImage = 128;
constexpr int kQuickFlightFrames = 8, kWholeFlightFrames = 60, kFlightImage = 64;
constexpr int kFlightSubject = 2;  ///< index into kQualitySubjects: the cloud

constexpr std::array<QualitySubject, 3> kCullingSubjects{{{"head", QualityColor::Skin, false},
                                                          {"head", QualityColor::Bone, false},
                                                          {"shells", QualityColor::Cloud, false}}};

/// Two of the volumes are also checked at a large size, to find errors that depend on size: a full one, which
/// is drawn in several chunks, and a sparse one.
struct ProceduralScene {
  const char* name;
  SceneColor color;
  bool alsoLarge = false;
};
constexpr std::array<ProceduralScene, 7> kProcedural{{{"cube", SceneColor::Density, true},
                                                      {"cloud", SceneColor::TransferFunction},
                                                      {"marschner-lobb", SceneColor::Density},
                                                      {"shells", SceneColor::TransferFunction},
                                                      {"rods", SceneColor::Density},
                                                      {"fire", SceneColor::Density},
                                                      {"head", SceneColor::TransferFunction, true}}};

/// `makeScene` is called when the job runs, so that a scene is only in memory while it is needed.
template <typename MakeScene>
void addScene(std::vector<SectionJob>& jobs, const Device& device, const std::string& name, glm::ivec2 image, const MakeScene& makeScene) {
  jobs.push_back({fmt::format("stages of {}", name), [=, &device] { return stageChecks(deviceStages(device), makeScene(), image); }});
  jobs.push_back({fmt::format("gather of {}", name), [=, &device] { return gatherChecks(deviceGather(device), makeScene(), image); }});
  jobs.push_back({fmt::format("invariances of {}", name), [=, &device] { return invariances(device, makeScene(), image); }});
  jobs.push_back({fmt::format("levels of {}", name), [=, &device] { return levelChecks(device, makeScene(), image); }});
}

std::vector<int> resolutions(const Extent& extent, int quick) {
  if (extent.resolution) return {*extent.resolution};
  return extent.quick ? std::vector{quick} : std::vector{kMedium, kLarge};
}

QualityScene openQualityScene(const Device& device, const QualitySubject& subject, int resolution) {
  return makeQualityScene(subject, resolution,
                          openProcedural(subject.procedural, glm::ivec3(resolution), maximumVoxels(device)));
}

/// Images have more than a pixel a voxel, since with fewer pixels no method shows its quality.
QualityRun qualityRun(const Extent& extent, int resolution) {
  const int whole = resolution >= kLarge ? kLargeQualityImage : kWholeQualityImage;
  return {.views = extent.quick ? quickQualityViews() : qualityViews(),
          .imageEdge = extent.quick ? kQuickQualityImage : whole,
          .hasGoals = resolution >= kMinResolutionWithGoals};
}

/// A job for each volume, and one that summarises their results.
void addQuality(std::vector<SectionJob>& jobs, const Device& device, const Extent& extent) {
  const auto found = std::make_shared<std::vector<QualityFigures>>();
  for (const int resolution : resolutions(extent, kQuickQuality))
    for (const QualitySubject& subject : kQualitySubjects)
      jobs.push_back({fmt::format("image quality of {} at {}^3", subject.procedural, resolution), [=, &device, &subject] {
                        auto [section, figures] = imageQuality(deviceStages(device), openQualityScene(device, subject, resolution),
                                                               qualityMethods(), qualityRun(extent, resolution));
                        found->push_back(std::move(figures));
                        return section;
                      }});
  jobs.push_back({"summary of image quality", [found] { return summariseQuality(*found, qualityMethods()); }});
}

void addTurntable(std::vector<SectionJob>& jobs, const Device& device) {
  jobs.push_back({"image quality around the head", [&device] {
                    return turntableQuality(deviceStages(device), openQualityScene(device, kQualitySubjects.front(), kTurntableResolution),
                                            kTurntableFrames, kTurntableImage);
                  }});
}

/// For the volumes without structures of the size of a voxel.
void addDetail(std::vector<SectionJob>& jobs, const Device& device, bool quick) {
  const int resolution = quick ? kQuickQuality : kDetailResolution;
  for (const QualitySubject& subject : kQualitySubjects) {
    if (subject.thin) continue;
    const auto scene = [=, &device, &subject] { return openQualityScene(device, subject, resolution); };
    jobs.push_back({fmt::format("level of detail of {}", subject.procedural),
                    [=, &device] { return detailQuality(device, scene()); }});
    if (!quick)
      jobs.push_back({fmt::format("zoom to {}", subject.procedural),
                      [=, &device] { return zoomQuality(device, scene()); }});
  }
}

void addFlight(std::vector<SectionJob>& jobs, const Device& device, const Extent& extent) {
  const int resolution = extent.quick ? kQuickQuality : kMedium;
  const int frames = extent.quick ? kQuickFlightFrames : kWholeFlightFrames;
  jobs.push_back({"image quality within the cloud", [=, &device] {
                    return flyThroughQuality(deviceStages(device), openQualityScene(device, kQualitySubjects[kFlightSubject], resolution),
                                             frames, kFlightImage);
                  }});
}

/// For the opaque head, of which most is hidden, and for the volumes of the quality checks.
void addCulling(std::vector<SectionJob>& jobs, const Device& device, const Extent& extent) {
  const int resolution = extent.quick ? kQuickQuality : kDetailResolution;
  const int edge = extent.quick ? kQuickQualityImage : kLargeQualityImage;
  for (const QualitySubject& subject : kCullingSubjects) {
    if (extent.quick && &subject != &kCullingSubjects.front()) continue;
    jobs.push_back({fmt::format("culling of {}", subject.procedural), [=, &device, &subject] {
                      return cullingChecks(device, openQualityScene(device, subject, resolution), edge);
                    }});
  }
}

/// For the volumes that are smooth and not opaque: shells and cloud of kQualitySubjects.
void addLight(std::vector<SectionJob>& jobs, const Device& device, bool quick) {
  const int resolution = quick ? kQuickProcedural : kDetailResolution;
  // The oracle's shadow rays are slow, so the quick run has the cloud only.
  for (const QualitySubject& subject : std::span(kQualitySubjects).subspan(quick ? 2 : 1, quick ? 1 : 2))
    jobs.push_back({fmt::format("light on {}", subject.procedural), [=, &device, &subject] {
                      return lightQuality(device, openQualityScene(device, subject, resolution),
                                          quick ? kQuickLightImage : kQuickQualityImage);
                    }});
  // With steep transfer functions the oracle takes a quarter of a minute for an image.
  for (const QualitySubject& subject : std::span(kCullingSubjects).first(quick ? 0 : 2)) {
    const char* const color = subject.color == QualityColor::Skin ? "skin" : "bone";
    jobs.push_back({fmt::format("light on the {}'s {}", subject.procedural, color), [=, &device, &subject] {
                      QualityScene scene = openQualityScene(device, subject, kMedium);
                      scene.name += fmt::format(", {}", color);
                      return opaqueLightQuality(device, scene, quickQualityViews(), kWholeQualityImage);
                    }});
  }
  const int sky = quick ? kQuickSky : kQuickProcedural;
  jobs.push_back({"light from all around", [=, &device] {
                    return environmentQuality(device, openQualityScene(device, kQualitySubjects[2], sky),
                                              quick ? kQuickLightImage : kQuickQualityImage);
                  }});
  jobs.push_back(
      {"emission of fire", [=, &device] { return emissionChecks(device, resolution, quick ? kQuickLightImage : kQuickQualityImage); }});
  jobs.push_back({"gather with lights", [&device] { return gatherLightChecks(deviceGather(device), kGatherLightImage); }});
  jobs.push_back(
      {"gather with light of all orders", [&device] { return gatherScatteringChecks(deviceGather(device), kGatherLightImage); }});
  jobs.push_back(
      {"gather of scalars with lights", [&device] { return gatherScalarLightChecks(deviceGather(device), kGatherScalarLightImage); }});
  jobs.push_back({"gather of surfaces", [&device] { return gatherSurfaceChecks(deviceGather(device)); }});
  jobs.push_back({"gather with lights and emission", [&device] { return gatherEmissionChecks(deviceGather(device), kGatherLightImage); }});
  jobs.push_back({"shadows", [=, &device] { return shadowChecks(device, resolution); }});
}

void addPaperFigures(std::vector<SectionJob>& jobs, const Device& device) {
  jobs.push_back({"figure 2 of the paper", [&device] { return paperFigure2(deviceStages(device)); }});
  jobs.push_back({"figure 6 of the paper", [&device] { return paperFigure6(deviceStages(device)); }});
  jobs.push_back({"figure 7 of the paper", [&device] { return paperFigure7(deviceStages(device)); }});
  jobs.push_back({"leakage against layers", [&device] { return leakageOfLayers(deviceStages(device), {}); }});
}

/// Quick runs do without: its times need large volumes, and tests check the bits.
void addCluster(std::vector<SectionJob>& jobs, const Device& device, const Extent& extent) {
  if (extent.quick) return;
  const int resolution = extent.resolution.value_or(kLarge);
  jobs.push_back({fmt::format("ranks of a cluster at {}^3", resolution),
                  [resolution, &device] { return clusterSection(clusterScalings(device, resolution)); }});
}

/// One view of a file's volume: the default method and sorted blending.
ReportSection fileQuality(const Device& device, const ValidationScene& scene, int imageEdge) {
  const std::vector<QualityMethod>& all = qualityMethods();
  const QualityView view;
  return imageQuality(deviceStages(device), {.name = scene.name, .volume = scene.volume, .classification = scene.classification},
                      {all.front(), all[sortedMethod(all)]}, {.views = {&view, 1}, .imageEdge = imageEdge})
      .section;
}

}  // namespace

std::vector<SectionJob> planSections(const Device& device, const Extent& extent) {
  const glm::ivec2 image(extent.quick ? kQuickImage : kWholeImage);
  const int cube = extent.quick ? kQuickCube : kWholeCube;
  std::vector<SectionJob> jobs;
  jobs.push_back({"closed forms", [&device, cube] { return closedForms(deviceStages(device), cube); }});
  for (const int resolution : resolutions(extent, kQuickProcedural))
    for (const ProceduralScene& scene : kProcedural) {
      if (resolution == kLarge && !extent.resolution && !scene.alsoLarge) continue;
      addScene(jobs, device, fmt::format("{} at {}^3", scene.name, resolution), image, [resolution, &scene, &device] {
        return makeValidationScene(openProcedural(scene.name, glm::ivec3(resolution), maximumVoxels(device)), scene.color, resolution);
      });
    }
  addPaperFigures(jobs, device);
  addDetail(jobs, device, extent.quick);
  addCulling(jobs, device, extent);
  addLight(jobs, device, extent.quick);
  addQuality(jobs, device, extent);
  if (!extent.quick && !extent.resolution) addTurntable(jobs, device);
  if (!extent.resolution) addFlight(jobs, device, extent);
  addCluster(jobs, device, extent);
  for (const std::string& file : extent.files) {
    const auto scene = std::make_shared<ValidationScene>(
        makeValidationScene(InputDescription{.volume = file}.open(maximumVoxels(device)), SceneColor::Density,
                            extent.quick ? kQuickFileEdge : kWholeFileEdge));
    addScene(jobs, device, file, image, [scene] { return *scene; });
    const int edge = extent.quick ? kQuickQualityImage : kWholeQualityImage;
    jobs.push_back({fmt::format("image quality of {}", file), [scene, edge, &device] { return fileQuality(device, *scene, edge); }});
  }
  if (extent.only) std::erase_if(jobs, [&](const SectionJob& job) { return job.name.find(*extent.only) == std::string::npos; });
  if (jobs.empty())
    fail(ErrorKind::Usage, "--only '{}' leaves no section: give a part of a name, such as light, quality or stages", *extent.only);
  return jobs;
}

}  // namespace freevoxels::validate
