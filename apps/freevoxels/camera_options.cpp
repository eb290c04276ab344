#include "apps/freevoxels/camera_options.h"

#include <CLI/CLI.hpp>

namespace freevoxels {

void CameraOptions::add(CLI::App& app) {
  CLI::Option* from = addTriple(app, "--camera-position", "X,Y,Z", position,
                                "Eye in world units [frames the volume, see --orbit]");
  CLI::Option* around =
      addPair(app, "--orbit", "AZIMUTH,ELEVATION", orbit,
              fmt::format(
                  "Eye in degrees around the volume: azimuth about +y from +z, elevation above the xz plane "
                  "[{},{}]",
                  kDefaultAzimuth, kDefaultElevation))
          ->excludes(from);
  CLI::Option* at =
      addTriple(app, "--look-at", "X,Y,Z", lookAt, "Point in the middle of the image [centre of the volume]");
  CLI::Option* upwards = addTriple(app, "--up", "X,Y,Z", up, "Direction that is up in the image [0,1,0]");
  CLI::Option* fov = addNumber(app, "--fov", "DEG", verticalFov,
                               fmt::format("Vertical field of view [{}]", Camera{}.verticalFov));
  CLI::Option* flat = addNumber(app, "--orthographic", "HEIGHT", orthographicHeight,
                                "Orthographic, the image HEIGHT world units high")
                          ->excludes(fov);
  CLI::Option* pixels =
      addSize(app, "--size", size, kMaximumImageEdge,
              fmt::format("Width and height of the image in pixels [{}x{}]", size.x, size.y));
  for (CLI::Option* option : {from, at, upwards, around, fov, flat, pixels}) option->group("Camera");
}

Camera CameraOptions::given() const {
  Camera camera;
  if (lookAt) camera.lookAt = *lookAt;
  if (position) camera.position = *position;
  if (up) camera.up = *up;
  if (verticalFov) camera.verticalFov = *verticalFov;
  camera.orthographic = orthographicHeight.has_value();
  if (orthographicHeight) camera.orthographicHeight = *orthographicHeight;
  return camera;
}

void CameraOptions::check() const {
  if (position && lookAt) {
    checkCamera(given());
    return;
  }
  Camera lens = given();
  lens.position = glm::dvec3(0.0, 0.0, 1.0);
  lens.lookAt = glm::dvec3(0.0);
  lens.up = up && *up == glm::dvec3(0.0) ? *up : glm::dvec3(0.0, 1.0, 0.0);
  checkCamera(lens);
}

Camera CameraOptions::resolve(const Volume& volume) const {
  Camera camera = given();
  if (!position || !lookAt) {
    const glm::dvec2 angles = orbit.value_or(glm::dvec2(kDefaultAzimuth, kDefaultElevation));
    const double aspect = double(size.x) / double(size.y);
    const Camera framing = framingCamera(volume, angles.x, angles.y, aspect, given());
    if (!lookAt) camera.lookAt = framing.lookAt;
    if (!position) {
      camera.position = camera.lookAt + (framing.position - framing.lookAt);
      camera.up = framing.up;
    }
  }
  checkCamera(camera);
  return camera;
}

void CameraOptions::describe(OptionList& options, const Camera& resolved) const {
  options.emplace_back("--camera-position", numberText(resolved.position));
  options.emplace_back("--look-at", numberText(resolved.lookAt));
  options.emplace_back("--up", numberText(resolved.up));
  if (resolved.orthographic)
    options.emplace_back("--orthographic", numberText(resolved.orthographicHeight));
  else
    options.emplace_back("--fov", numberText(resolved.verticalFov));
  options.emplace_back("--size", fmt::format("{}x{}", size.x, size.y));
}

}  // namespace freevoxels
