// What a block of albedo 1 scatters towards the eye of the light that it gets: Subr et al. 2007, Section 4.3. Include after
// block_depth.glsl and self_attenuation.glsl; `frame` is the SetupFrame,
// `lights` its lights.

// The mean over a ball of a block's volume of 1 / distance² from its middle is 1 over this much of the edge's square: no
// block has more light from a source that is in it.
const float kNearestLight2 = 0.1283;

// Of Henyey and Greenstein, per steradian, from `before` to `after`, both of length 1. 1 + g² - 2 g cos without the
// difference of large terms.
float phaseFunction(float g, vec3 before, vec3 after) {
  const vec3 apart = after - sign(g) * before;
  const float width = (1.0 - abs(g)) * (1.0 - abs(g)) + abs(g) * dot(apart, apart);
  return (1.0 - g * g) / (4.0 * 3.14159265358979 * width * sqrt(width));
}

// What of a light reaches a block, in the mean over it. `depth` and `falling` as depthTowards has them.
float reaching(Block block, float sigma, vec3 direction, float depth, float falling) {
  const float layer = layerLength(direction);
  const float counted = frame.pathLengthCorrection != 0 ? layer : frame.voxelSize;
  const float inFront = depthInFront(block, direction, depth, falling * sigma * counted);
  return exp(-inFront) * selfAttenuation(sigma * layer * float(layersOf(block, direction)));
}

vec3 scatteredFrom(Light light, Block block, float sigma, uint rank, vec3 toEye) {
  vec3 toLight = light.place;
  float distance2 = 1.0;
  if (light.atInfinity == 0) {
    toLight -= block.center - frame.middle;
    const vec3 way = frame.indexToWorld * toLight;
    const float edge = float(block.edge) * frame.voxelSize;
    distance2 = max(dot(way, way), kNearestLight2 * edge * edge);
    if (dot(toLight, toLight) < kAtSource * kAtSource) toLight = vec3(0.0, 0.0, 1.0);
    toLight = acrossLayer(toLight);
  }
  float falling;
  const float depth = depthTowards(towardsSource(toLight, frame.lighting.lookup, light.beyond), rank, falling);
  const float phase = phaseFunction(frame.lighting.phaseG, -normalize(frame.indexToWorld * toLight), toEye);
  return light.color * (phase * reaching(block, sigma, toLight, depth, falling) / distance2);
}

// The mean of what reaches the block from all directions: what is dark from everywhere is dark in ambient light.
float reachingFromAll(Block block, float sigma, uint rank) {
  const Towards towards = towardsSource(vec3(0.0, 0.0, 1.0), frame.lighting.lookup, uvec2(0));
  const int edge = 2 * frame.cells + 1;
  float sum = 0.0;
  for (int i = 0; i < edge * edge * edge; ++i) {
    if (frame.lighting.shares[i] == 0.0) continue;  // no direction: inside of the cube
    const ivec3 cell = ivec3(i % edge, i / edge % edge, i / edge / edge) - frame.cells;
    const float depth = decodeDepth(frame.code, storedCode(towards, cell, rank));
    const float falling = isAtEnd(towards, cell, rank) ? 0.0 : 1.0;
    sum += frame.lighting.shares[i] * reaching(block, sigma, vec3(cell) / float(frame.cells), depth, falling);
  }
  return sum;
}

// Per albedo. `towardsEye` is as directionToEye has it.
vec3 scatteredLight(Block block, float sigma, uint rank, vec3 towardsEye) {
  const vec3 toEye = normalize(frame.indexToWorld * towardsEye);
  vec3 sum = vec3(0.0);
  for (int i = 0; i < frame.lighting.lightCount; ++i) sum += scatteredFrom(lights[i], block, sigma, rank, toEye);
  if (frame.lighting.ambient != vec3(0.0)) sum += frame.lighting.ambient * reachingFromAll(block, sigma, rank);
  return sum;
}
