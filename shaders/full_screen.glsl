// A triangle that covers the viewport, of the vertices 0 to 2.
#ifndef FULL_SCREEN_GLSL
#define FULL_SCREEN_GLSL

vec4 fullScreenVertex() {
  const vec2 corner = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1);
  return vec4(4.0 * corner - 1.0, 0.0, 1.0);
}

#endif
