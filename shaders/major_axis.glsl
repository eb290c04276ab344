// The axis of a direction's largest component, the first of several.
#ifndef MAJOR_AXIS_GLSL
#define MAJOR_AXIS_GLSL

int majorAxis(vec3 direction) {
  const vec3 size = abs(direction);
  return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
}

#endif
