#version 460
// A triangle that covers the viewport.
#extension GL_GOOGLE_include_directive : require
#include "full_screen.glsl"

void main() { gl_Position = fullScreenVertex(); }
