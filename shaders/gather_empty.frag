#version 460
// Empties the images that the gather then draws tiles of: pixels that see nothing. Drawn, as lavapipe clears pixel by pixel.

layout(location = 0) out vec4 colorOut;
#ifdef WITH_DISTANCE
layout(location = 1) out float distanceOut;
#endif

void main() {
  colorOut = vec4(0.0);
#ifdef WITH_DISTANCE
  distanceOut = uintBitsToFloat(0x7f800000u);
#endif
}
