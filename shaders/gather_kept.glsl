// What the loops of a march read of the frame, copied before them: lavapipe loads a uniform for each lane by itself wherever it is read, in
// some 27 instructions, which took a third of a lit march.
#ifndef GATHER_KEPT_GLSL
#define GATHER_KEPT_GLSL
#include "gather_frame.glsl"

struct KeptFrame {
  SampleLight lights[kMaxSampleLights];
  ScatteredGrid scattered;
  vec3 tint;
  float forward;
  vec3 deltaScale;
  float phaseG, surface, nearestLight2;
  mat3 indexToWorld, gradientToWorld;
  float extinctionUnit, sourceUnit;
  vec3 color;
  float quarters;
  vec3 clipLow, clipHigh, clipNormal;
  float clipDistance;
};
KeptFrame kept;

void keepFrame() {
  [[unroll]] for (int i = 0; i < kMaxSampleLights; ++i) kept.lights[i] = frame.lights[i];
  kept.scattered = frame.scattered;
  kept.tint = frame.tint;
  kept.forward = frame.forward;
  kept.deltaScale = frame.deltaScale;
  kept.phaseG = frame.phaseG;
  kept.surface = frame.surface;
  kept.nearestLight2 = frame.nearestLight2;
  kept.indexToWorld = frame.indexToWorld;
  kept.gradientToWorld = frame.gradientToWorld;
  kept.extinctionUnit = frame.extinctionUnit;
  kept.sourceUnit = frame.sourceUnit;
  kept.color = frame.color;
  kept.quarters = frame.quarters;
  kept.clipLow = frame.clipLow;
  kept.clipHigh = frame.clipHigh;
  kept.clipNormal = frame.clipNormal;
  kept.clipDistance = frame.clipDistance;
}

#endif
