#version 460
// Panels and images of the viewer's window: triangles of Dear ImGui.
#extension GL_GOOGLE_include_directive : require
#include "ui_interface.h"

layout(scalar, push_constant) uniform Push { UiPush push; };
layout(scalar, binding = 0) readonly buffer Vertices { UiVertex vertices[]; };

layout(location = 0) out vec4 color;
layout(location = 1) out vec2 texel;

void main() {
  const UiVertex vertex = vertices[gl_VertexIndex];
  color = unpackUnorm4x8(vertex.color);
  texel = vertex.texel;
  gl_Position = vec4(vertex.position * push.scale + push.offset, 0.0, 1.0);
}
