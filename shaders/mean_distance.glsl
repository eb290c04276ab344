// Sums of e times distance, for an interpolation with weights of both signs. Where the energies nearly
// cancel, the quotient of the two sums could be any number, so the mean distance is clamped to the range of
// the samples' own distances. A negative sum marks a sample without a distance.
#ifndef MEAN_DISTANCE_GLSL
#define MEAN_DISTANCE_GLSL
#include "gather_interface.h"

struct MeanDistance {
  float sum;        // of weight times e times distance
  float low, high;  // range of the samples' mean distances; low > high if there are none
};

const MeanDistance kNoDistance = MeanDistance(0.0, 3e38, 0.0);

void addSample(inout MeanDistance mean, float weight, float energy, float distances) {
  if (energy <= 0.0 || distances < 0.0) return;
  mean.sum += weight * distances;
  if (energy < kMinRangeEnergy) return;
  const float distance = distances / energy;
  mean.low = min(mean.low, distance);
  mean.high = max(mean.high, distance);
}

float distancesOf(MeanDistance mean, float energy) {
  if (energy <= 0.0 || mean.low > mean.high) return -1.0;
  return clamp(mean.sum, energy * mean.low, energy * mean.high);
}

#endif
