// The footprint of a block on the image.
#ifndef SPLAT_PROJECTION_GLSL
#define SPLAT_PROJECTION_GLSL
#include "part_ahead.glsl"
#include "setup_frame.glsl"

const float kBeyondImage = 1e6;  // pixels
const float kBoundsSlack = 2.0;  // in pixels: margin for rounding and for widened footprints

bool besideImage(vec2 low, vec2 high) {
  const vec2 beyond = 0.5 * frame.imageSize + kBoundsSlack;
  return any(lessThan(high, -beyond)) || any(greaterThan(low, beyond));
}

struct Footprint {
  vec2 center, halfExtent;
  vec3 conic;
  float amplitude;  // 1, or less if the footprint is widened
  float edge2;      // square of the edge in pixels in its shortest direction
  float distance;
  float ahead;      // orthographic: the approximate part of the kernel in front of the eye plane
  bool cut;         // whether a perspective camera's eye plane cuts the kernel
};

// Widens a footprint that is too narrow for the pixel lattice and keeps its integral. `shape` has the squared
// semi-axes (xx, xy, yy) in pixels, `scale` is |D|² at the centre.
void widenToPixel(inout Footprint footprint, vec3 shape, float scale) {
  const float before = shape.x * shape.z - shape.y * shape.y;
  const float largest = 0.5 * (shape.x + shape.z) + length(vec2(0.5 * (shape.x - shape.z), shape.y));
  footprint.edge2 = before / largest / (kSplatRadius * kSplatRadius);
  const float missing = kSplatRadius * kSplatRadius - before / largest;
  if (missing <= 0.0) return;
  const vec3 widened = shape + vec3(missing, 0.0, missing);
  const float after = widened.x * widened.z - widened.y * widened.y;
  footprint.conic = vec3(widened.z, -widened.y, widened.x) * (scale / after);
  footprint.amplitude = sqrt(max(before, 0.0) / after);
}

// The bounds of conic(d) <= |D + d.x pixelX + d.y pixelY|², with D the ray of the centre: low and high edge. Without bounds where this
// is no ellipse.
vec4 boundsOf(Footprint footprint, vec3 ray) {
  const bool parallel = frame.orthographic != 0;
  const vec3 x = parallel ? vec3(0.0) : frame.pixelX, y = parallel ? vec3(0.0) : frame.pixelY;
  const vec2 slope = vec2(dot(ray, x), dot(ray, y));
  const vec3 matrix = footprint.conic - vec3(dot(x, x), dot(x, y), dot(y, y));
  const float determinant = matrix.x * matrix.z - matrix.y * matrix.y;
  if (!(determinant > 0.0) || !(matrix.x > 0.0)) return vec4(vec2(-kBeyondImage), vec2(kBeyondImage));
  const vec3 inverse_ = vec3(matrix.z, -matrix.y, matrix.x) / determinant;
  const vec2 shift = vec2(dot(inverse_.xy, slope), dot(inverse_.yz, slope));
  const vec2 spread = sqrt((dot(ray, ray) + dot(slope, shift)) * inverse_.xz);
  return footprint.center.xyxy + vec4(shift - spread, shift + spread);
}

// The positions x along an axis of the image at which rays can pass a kernel that the eye plane cuts: (k - x
// z)² <= R² |row - x rowZ|², with k and z the position of its centre along `row` and `rowZ`. This is not the
// range between two roots, but that on one side of them; on the other side is what lies behind the eye.
vec2 cutBounds(float k, float z, vec3 row, vec3 rowZ) {
  const float radius2 = kSplatRadius * kSplatRadius;
  const float a = z * z - radius2 * dot(rowZ, rowZ);
  const float b = k * z - radius2 * dot(row, rowZ);
  const float c = k * k - radius2 * dot(row, row);
  const float discriminant = b * b - a * c;
  if (!(discriminant > 0.0)) return vec2(-kBeyondImage, kBeyondImage);
  const float larger = b + (b < 0.0 ? -1.0 : 1.0) * sqrt(discriminant);
  const float near = c / larger;
  const float far = clamp(larger / min(a, -1e-30), -kBeyondImage, kBeyondImage);
  return k > near * z ? vec2(max(near, far) - kBoundsSlack, kBeyondImage)
                      : vec2(-kBeyondImage, min(near, far) + kBoundsSlack);
}

// The footprint of a cut kernel is integrated along each pixel's ray from the eye on. `conic` is the distance
// along the ray of the image's middle to the kernel's centre, times |D|, and its change per pixel.
bool projectCut(vec3 q, vec3 pixel, inout Footprint footprint) {
  const mat3 rows = transpose(frame.indexToPixel);
  const vec2 x = cutBounds(pixel.x, pixel.z, rows[0], rows[2]);
  const vec2 y = cutBounds(pixel.y, pixel.z, rows[1], rows[2]);
  footprint.center = 0.5 * vec2(x.x + x.y, y.x + y.y);
  footprint.halfExtent = 0.5 * vec2(x.y - x.x, y.y - y.x);
  footprint.conic = vec3(dot(q, frame.ray), dot(q, frame.pixelX), dot(q, frame.pixelY));
  footprint.cut = true;
  return !besideImage(vec2(x.x, y.x), vec2(x.y, y.y));
}

// Projects the kernel's sphere of radius R, times the edge of a block, around the index position `offset`
// (from the volume's middle) as seen from the eye: all rays D with |q x D|² <= R² |D|². Returns false behind
// the eye and beside the image. The eye plane may cut voxels' kernels, but none of a coarser
// block.
bool project(vec3 offset, float edge, out Footprint footprint) {
  const vec3 q = offset + frame.eyeToMiddle;
  const vec3 pixel = frame.indexToPixel * offset + frame.middleInPixels;
  const float radius2 = (kSplatRadius * edge) * (kSplatRadius * edge);
  const vec3 ray = frame.orthographic != 0 ? frame.ray : q / pixel.z;
  const vec3 u = frame.orthographic != 0 ? cross(frame.pixelX, ray) : cross(q, frame.pixelX);
  const vec3 v = frame.orthographic != 0 ? cross(frame.pixelY, ray) : cross(q, frame.pixelY);
  const vec3 quadric = vec3(dot(u, u), dot(u, v), dot(v, v));
  const float scale = dot(ray, ray);
  const vec3 shape =
      vec3(quadric.z, -quadric.y, quadric.x) * (radius2 * scale / (quadric.x * quadric.z - quadric.y * quadric.y));
  footprint.conic = quadric / radius2;
  footprint.amplitude = 1.0;
  footprint.distance = max(pixel.z, 0.0);
  footprint.ahead = 1.0;
  footprint.cut = false;
  const mat3 rows = transpose(frame.indexToPixel);
  const float reach = kSplatRadius * edge * length(rows[2]);
  if (pixel.z <= -reach) return false;

  if (frame.orthographic != 0) {
    footprint.center = pixel.xy;
    footprint.ahead = partAhead(pixel.z / reach);
  } else {
    const float nearest = pixel.z * pixel.z - radius2 * dot(rows[2], rows[2]);
    if (pixel.z <= 0.0 || nearest <= 0.0) return projectCut(q, pixel, footprint);
    footprint.center = pixel.xy / pixel.z;
  }
  widenToPixel(footprint, shape, scale);
  const vec4 bounds = boundsOf(footprint, ray);
  footprint.halfExtent = max(footprint.center - bounds.xy, bounds.zw - footprint.center);
  return !besideImage(bounds.xy, bounds.zw);
}

#endif
