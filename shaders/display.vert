#version 460
// A triangle that covers the viewport, and what is the same for all pixels, as lavapipe loads uniforms for each pixel by itself.
#extension GL_GOOGLE_include_directive : require
#include "display_interface.h"

layout(scalar, push_constant) uniform Push { DisplayPush push; };
layout(location = 0) flat out vec2 gainHeight;
layout(location = 1) flat out vec3 top;
layout(location = 2) flat out vec3 bottom;

void main() {
  gainHeight = vec2(push.gain, push.height);
  top = push.top;
  bottom = push.bottom;
  const vec2 corner = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1);
  gl_Position = vec4(4.0 * corner - 1.0, 0.0, 1.0);
}
