#pragma once
// Flights as JSON: {"keys": [{"time": 0, "camera-position": [3, 1, 2], "look-at": [0, 0, 0], "light": [{"direction": [1, 1, 0]}]}, ...]},
// with the names and values of the fields of a scene (apps/scenes/README.md).

#include <string>
#include <vector>

#include "engine/description/scene_description.h"
#include "engine/scene/flight.h"

namespace freevoxels {

inline constexpr std::size_t kMinFlightKeys = 2, kMaxFlightKeys = 10000;

struct FlightKeyDescription {
  double time = 0.0;  ///< in any unit, -1e30 to 1e30
  /// Position and look-at point, and what is given of up direction, field of view and orthographic height; the rest is not used.
  CameraDescription camera;
  std::vector<LightingDescription::GivenLight> lights;  ///< none where the key says nothing of them

  bool operator==(const FlightKeyDescription&) const = default;
};

/// kMinFlightKeys to kMaxFlightKeys keys in ascending order of time, all perspective or all orthographic.
struct FlightDescription {
  std::vector<FlightKeyDescription> keys;

  /// What keys leave open is chosen for the volume: up directions, and the intensities of lights. Fails with ErrorKind::Input for an up
  /// direction of the volume along the view of a key.
  Flight resolve(const Volume& volume) const;

  bool operator==(const FlightDescription&) const = default;
};

/// Reads a file, or JSON that begins with {, as CameraDescription::flight names it. Fails with ErrorKind::Input and a sentence that names
/// the file and the key, which are counted from 1.
FlightDescription readFlight(const std::string& text);
/// The JSON of a flight, in one line, of which readFlight() makes an equal one.
std::string flightText(const FlightDescription& flight);

/// What each of `frameCount` frames shows, at equal steps of time, of the flight that `text` names. Fails as readFlight() and
/// FlightDescription::resolve(), and where a camera between two keys cannot produce an image (checkCamera).
std::vector<FrameView> flightViews(const std::string& text, const Volume& volume, int frameCount);

/// The lighting with the lights of the flight's first frame in place of its own, where the flight has any. Fails as readFlight().
LightingDescription lightingOfFlight(const LightingDescription& lighting, const std::string& text);

}  // namespace freevoxels
