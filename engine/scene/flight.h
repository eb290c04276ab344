#pragma once
// Flights: a camera and lights that move smoothly through key frames.

#include <vector>

#include "engine/scene/camera.h"
#include "engine/scene/lighting.h"

namespace freevoxels {

struct FlightKey {
  double time = 0.0;  ///< in any unit
  Camera camera;
  std::vector<Light> lights;  ///< none where the key says nothing of them
};

/// One key or more in ascending order of time, with cameras that pass checkCamera, all perspective or all orthographic.
struct Flight {
  std::vector<FlightKey> keys;

  /// The time of a frame, 0 <= frame < frames, of frames in equal steps from the first key to the last. One frame is at the first key.
  double timeOfFrame(int frame, int frames) const;

  /// The camera at a time; before the first key and after the last it is theirs. Position, look-at point, up direction and the logarithm
  /// of the size of what is seen follow cubic Hermite splines that have the values of the keys (non-uniform Catmull-Rom). At a key the
  /// derivative by time is the difference between both neighbours over the time between them, at the ends that to the only neighbour, so
  /// that it is continuous, and two keys make a straight line at constant speed. `up` has length 1; where those of two keys are more than
  /// a right angle apart it turns with the orientation of the camera. Between keys a camera may fail checkCamera, as where its position
  /// meets the look-at point.
  Camera cameraAt(double time) const;

  /// The lights at a time; none if no key has any. They change linearly from a key with lights to the next such key if both have
  /// as many directions and positions in the same order; otherwise those of the earlier key stay until the later one. Before the first
  /// key with lights they are those of it. Directions between keys have length 1.
  std::vector<Light> lightsAt(double time) const;
};

}  // namespace freevoxels
