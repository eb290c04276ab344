#version 460
// A triangle that covers the viewport, and what is the same for all pixels, as lavapipe loads uniforms for each pixel by itself.
#extension GL_GOOGLE_include_directive : require
#include "display_interface.h"
#include "full_screen.glsl"

layout(scalar, push_constant) uniform Push { DisplayPush push; };
layout(location = 0) flat out float gain;
layout(location = 1) flat out float height;
layout(location = 2) flat out vec3 top;
layout(location = 3) flat out vec3 bottom;

void main() {
  gain = push.gain;
  height = float(push.height);
  top = push.top;
  bottom = push.bottom;
  gl_Position = fullScreenVertex();
}
