// A pixel from its sums: Subr et al. 2007, Eq. 10. The transmittance is exact, so E is the pixel's alpha and nothing is to be
// normalised; only the interpolation may leave the range. A negative distance is none (mean_distance.glsl). Include after the
// images; kWithDistance says whether distanceImage is written.

void resolvePixel(ivec2 pixel, vec4 colorEnergy, float distance) {
  const float alpha = clamp(colorEnergy.a, 0.0, 1.0);
  imageStore(colorImage, pixel, vec4(max(colorEnergy.rgb, vec3(0.0)), alpha));
  if (kWithDistance)
    imageStore(distanceImage, pixel, vec4(alpha > 0.0 && distance >= 0.0 ? distance / alpha : uintBitsToFloat(0x7f800000u)));
}
