// A block's footprint on the image. Include after interface.h; `frame` is the SetupFrame.

struct Footprint {
  vec2 center, halfExtent;
  vec3 conic;
  float amplitude;  // 1, less where the footprint is widened
  float edge2;      // square of the edge in pixels where it is shortest
  float distance;
};

// A footprint narrower than the pixel lattice can sample is widened to it, with its integral kept: `shape`
// holds the squared semi-axes (xx, xy, yy) in pixels, `scale` is |D|² at the centre.
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
  footprint.halfExtent *= sqrt(widened.xz / shape.xz);
}

// The kernel's sphere of radius R, times the edge of a block, around the index position `offset` (from the
// volume's middle) seen from the eye: all rays D with |q x D|² <= R² |D|². Returns false behind the eye, and in
// perspective also where it reaches the eye plane.
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
  footprint.distance = pixel.z;
  if (pixel.z <= 0.0) return false;

  if (frame.orthographic != 0) {
    footprint.center = pixel.xy;
    footprint.halfExtent = sqrt(shape.xz);
  } else {
    // The bounds of the projected sphere, from its dual conic R² K Kᵀ - k kᵀ in pixels around the centre.
    const mat3 rows = transpose(frame.indexToPixel);
    const float nearest = pixel.z * pixel.z - radius2 * dot(rows[2], rows[2]);
    if (nearest <= 0.0) return false;
    footprint.center = pixel.xy / pixel.z;
    const vec3 rowX = rows[0] - footprint.center.x * rows[2];
    const vec3 rowY = rows[1] - footprint.center.y * rows[2];
    const vec2 shift = radius2 * vec2(dot(rowX, rows[2]), dot(rowY, rows[2]));
    const vec2 reach = sqrt(shift * shift + radius2 * vec2(dot(rowX, rowX), dot(rowY, rowY)) * nearest);
    footprint.halfExtent = (abs(shift) + reach) / nearest;
  }
  widenToPixel(footprint, shape, scale);
  return true;
}
