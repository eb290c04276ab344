#include "apps/freevoxels/camera_options.h"

#include <CLI/CLI.hpp>

#include "engine/scene/orbit.h"
#include "engine/volume/subject.h"

namespace freevoxels {

void CameraOptions::add(CLI::App& app) {
  CLI::Option* from = addTriple(app, "--camera-position", "X,Y,Z", position,
                                "Position of the eye in world units [around the volume, see --orbit]");
  CLI::Option* around =
      addPair(app, "--orbit", "AZIMUTH,ELEVATION", orbit,
              fmt::format(
                  "Direction of the eye around the volume in degrees: azimuth about the up direction (if +y is up, from +z "
                  "towards +x), elevation; the volume fills the image [{},{}]",
                  kDefaultAzimuth, kDefaultElevation))
          ->excludes(from);
  CLI::Option* at =
      addTriple(app, "--look-at", "X,Y,Z", lookAt, "Point in the middle of the image [the middle of the visible volume]");
  CLI::Option* upwards = addTriple(app, "--up", "X,Y,Z", up, "Up direction of the image [0,1,0; for scans and files of Blender 0,0,1]");
  CLI::Option* fov = addNumber(app, "--fov", "DEG", verticalFov,
                               fmt::format("Vertical field of view [{}]", Camera{}.verticalFov));
  CLI::Option* flat = addNumber(app, "--orthographic", "HEIGHT", orthographicHeight,
                                "Orthographic projection; the image is HEIGHT world units high [perspective]")
                          ->excludes(fov);
  CLI::Option* pixels =
      addSize(app, "--size", size, kMaximumImageEdge,
              fmt::format("Image size in pixels, or one number for a square [{}x{}]", size.x, size.y));
  for (CLI::Option* option : {from, at, upwards, around, fov, flat, pixels}) option->group("Camera");
}

void CameraOptions::look(const Camera& from) {
  *this = {.position = from.position, .lookAt = from.lookAt, .up = from.up, .size = size};
  if (from.orthographic)
    orthographicHeight = from.orthographicHeight;
  else
    verticalFov = from.verticalFov;
}

Camera CameraOptions::given(glm::dvec3 upwards) const {
  Camera camera{.up = upwards};
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

glm::dvec2 CameraOptions::angles() const {
  return orbit.value_or(glm::dvec2(kDefaultAzimuth, kDefaultElevation));
}

std::vector<Camera> CameraOptions::resolve(const Volume& volume, const Classification& classification, int frames) const {
  return resolve(volume.up, [&] { return contentOf(volume, classification); }, frames);
}

std::vector<Camera> CameraOptions::resolve(glm::dvec3 upOfVolume, const std::function<Subject()>& content, int frames) const {
  const Camera base = given(upOfVolume);
  if (position && lookAt) {
    checkCamera(base);
    return orbitAboutUp(base, frames);
  }
  Subject subject = content();
  if (position) {
    Camera start = base;
    start.lookAt = subject.centre;
    checkCamera(start);
    return orbitAboutUp(start, frames);
  }
  const double aspect = double(size.x) / double(size.y);
  if (frames == 1 && !lookAt)
    subject.centre = imageCentre(framingCamera(subject, angles().x, angles().y, aspect, base), subject);
  std::vector<Camera> cameras = framingOrbit(subject, angles().x, angles().y, frames, aspect, base);
  for (Camera& camera : cameras) {
    const glm::dvec3 at = lookAt.value_or(camera.lookAt);
    camera.position = at + (camera.position - camera.lookAt);
    camera.lookAt = at;
    camera.orthographicHeight = base.orthographicHeight;
    checkCamera(camera);
  }
  return cameras;
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

void CameraOptions::describeTurn(OptionList& options) const {
  if (position) return;
  std::erase_if(options, [this](const auto& option) {
    return option.first == "--camera-position" || (option.first == "--look-at" && !lookAt);
  });
  options.emplace_back("--orbit", numberText(angles().x) + "," + numberText(angles().y));
}

}  // namespace freevoxels
