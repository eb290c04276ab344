#version 460
// Premultiplied, and sRGB as it is shown: Dear ImGui's colours are.

layout(binding = 1) uniform sampler2D image;

layout(location = 0) in vec4 color;
layout(location = 1) in vec2 texel;
layout(location = 0) out vec4 shown;

void main() {
  const vec4 straight = color * texture(image, texel);
  shown = vec4(straight.rgb * straight.a, straight.a);
}
