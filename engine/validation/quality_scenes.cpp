#include "engine/validation/quality_scenes.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "engine/core/error.h"
#include "engine/volume/subject.h"

namespace freevoxels {

namespace {

/// The resolution to whose voxels opacities refer, so that volumes of other resolutions show the same medium.
constexpr double kUnitResolution = 64.0;

constexpr std::array<QualityView, 12> kViews{{{0, 0},
                                              {90, 0},
                                              {0, 90},
                                              {45, 0},
                                              {0, -45},
                                              {45, 35.264},
                                              {35, 25},
                                              {200, 10},
                                              {110, -35},
                                              {26.565, 12.604},
                                              {26.565, 24.095},
                                              {300, 15, 100}}};
constexpr std::array<QualityView, 3> kQuickViews{{{0, 0}, {35, 25}, {300, 15, 100}}};

using Opacities = std::vector<TransferFunction::OpacityPoint>;
using Colors = std::vector<TransferFunction::ColorPoint>;

/// Over the scalars 0 to 1.
TransferFunction bone() {
  return {.opacity =
              Opacities{
                  {0.0f, 0.0f}, {0.05f, 0.0f}, {0.15f, 0.004f}, {0.5f, 0.006f}, {0.7f, 0.35f}, {1.0f, 0.6f}},
          .color = Colors{{0.0f, {0.8f, 0.35f, 0.25f}},
                          {0.4f, {0.85f, 0.45f, 0.35f}},
                          {0.6f, {0.9f, 0.8f, 0.65f}},
                          {1.0f, {0.98f, 0.95f, 0.88f}}}};
}

/// Over 0 to 1, which stand for the volume's least and largest scalars.
TransferFunction cloud() {
  return {.opacity = Opacities{{0.0f, 0.0f},
                               {0.1f, 0.0f},
                               {0.18f, 0.05f},
                               {0.26f, 0.008f},
                               {0.42f, 0.015f},
                               {0.5f, 0.12f},
                               {0.58f, 0.03f},
                               {0.72f, 0.25f},
                               {1.0f, 0.85f}},
          .color = Colors{{0.0f, {0.02f, 0.1f, 0.4f}},
                          {0.2f, {0.06f, 0.25f, 0.7f}},
                          {0.4f, {0.5f, 0.1f, 0.35f}},
                          {0.5f, {0.85f, 0.12f, 0.04f}},
                          {0.65f, {1.0f, 0.33f, 0.02f}},
                          {0.8f, {1.0f, 0.7f, 0.2f}},
                          {1.0f, {1.0f, 0.95f, 0.7f}}}};
}

/// Over the scalars 0 to 1.
TransferFunction skin() {
  TransferFunction function = bone();
  function.opacity = Opacities{{0.0f, 0.0f}, {0.1f, 0.0f}, {0.12f, 1.0f}};
  return function;
}

TransferFunction colored(QualityColor color) {
  switch (color) {
    case QualityColor::Bone:
      return bone();
    case QualityColor::Cloud:
      return cloud();
    case QualityColor::Skin:
      return skin();
  }
  throw InternalError("no such colour");
}

void stretch(TransferFunction& function, float low, float high) {
  for (auto& point : function.opacity) point.scalar = low + point.scalar * (high - low);
  for (auto& point : function.color) point.scalar = low + point.scalar * (high - low);
}

}  // namespace

TransferFunction qualityTransferFunction(QualityColor color, const Volume& volume) {
  TransferFunction function = colored(color);
  if (color == QualityColor::Cloud) stretch(function, volume.minimum, volume.maximum);
  function.unitDistance = volume.voxelSize();
  return function;
}

QualityScene makeQualityScene(const QualitySubject& subject, int resolution, Volume volume) {
  QualityScene scene{.name = fmt::format("{} at {}^3", subject.procedural, resolution),
                     .volume = std::move(volume),
                     .classification = {},
                     .thin = subject.thin,
                     .resolution = resolution};
  cropToActive(scene.volume);
  TransferFunction function = qualityTransferFunction(subject.color, scene.volume);
  function.unitDistance *= resolution / kUnitResolution;
  scene.classification.transferFunction = std::move(function);
  scene.classification.order = ClassificationOrder::Pre;  // as splats use it
  return scene;
}

std::span<const QualityView> qualityViews() {
  return kViews;
}

std::span<const QualityView> quickQualityViews() {
  return kQuickViews;
}

std::string viewText(const QualityView& view) {
  const bool usual = view.verticalFov == QualityView{}.verticalFov;
  return fmt::format("({:g}, {:g}){}", view.azimuth, view.elevation,
                     usual ? "" : fmt::format(", {:g}° wide", view.verticalFov));
}

Camera viewCamera(const Volume& volume, const QualityView& view) {
  return framingCamera(volume, view.azimuth, view.elevation, 1.0, {.verticalFov = view.verticalFov});
}

}  // namespace freevoxels
