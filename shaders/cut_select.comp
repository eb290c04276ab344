#version 460
// First pass of the cut through the octree, one dispatch for each level, from the coarsest: which of the
// level's candidates are drawn (a bit for each slot, cut_frame.glsl), and how many of each workgroup. Subr et
// al. 2007, Section 3.3: the level is chosen by size on the image. Blocks outside of the image and hidden
// blocks are left out with everything below them.
//
// A parent is twice as large as its children and as near to the eye as the nearest of them. Therefore exactly
// one of the blocks around a voxel is drawn, unless it is left out.
#extension GL_GOOGLE_include_directive : require
#define OCCUPANCY_BINDING 2
#define PLANE_ADDRESSES_BINDING 7
#include "cut_frame.glsl"
#include "table_occlusion.glsl"

// Whether the level is that of the voxels. A specialisation constant, because lavapipe executes branches that
// no thread takes.
layout(constant_id = 1) const bool kVoxels = false;

// Whether only some of the blocks are candidates (engine/visibility/cut_candidates.h).
layout(constant_id = 2) const bool kSome = false;

layout(local_size_x = kCutThreads) in;
layout(scalar, binding = 3) buffer Opened { uint opened[]; };  // a bit for each block above the voxels: whether to test its children
layout(scalar, binding = 4) writeonly buffer Masks { uint masks[]; };
layout(scalar, binding = 5) buffer GroupCounts { uint groupCounts[]; };
layout(scalar, binding = 6) buffer Counts { CutCounts counts; };
// kSome: for each parent of the list, a bit for each child that is a candidate.
layout(scalar, binding = 8) readonly buffer Candidates { uint candidates[]; };

shared CutCounts sums;
shared uint asked[kCutSlotsPerGroup];  // the slots to test, in any order
shared uint askedCount;
shared uint mask[kCutThreads];
shared uint drawn;

// The centre of a block, relative to the volume's middle. Its part beyond the volume counts too.
vec3 centerOf(ivec3 cell, int edge) { return (vec3(cell) + 0.5) * float(edge) - 0.5 - frame.middle; }

bool isSmall(vec3 center, int edge) {
  const float reach = 0.5 * float(edge) * dot(abs(frame.viewAxis), vec3(1.0));
  return float(edge) <= frame.edgePerDistance * (dot(frame.viewAxis, center) + frame.middleDistance - reach);
}

bool isOutside(vec3 center, int edge) {
  if (frame.outside == 0) return false;
  const float reach = 0.5 * float(edge) + kSplatRadius * float(edge);
  for (int i = 0; i < 5; ++i) {
    const vec4 plane = frame.planes[i];
    if (dot(plane.xyz, center) + plane.w + reach * dot(abs(plane.xyz), vec3(1.0)) < 0.0) return true;
  }
  return false;
}

// The index of a slot's parent among the blocks above the voxels: its rank. The list of all blocks is in the order of ranks.
uint parentPlace(uint slot) {
  const BlockLevel level = frame.levels[push.level + 1];
  return (kSome ? rankAt(level, parents[slot / 8]) : level.firstRank + slot / 8) - frame.coarseFirst;
}

// Which of a thread's slots to test, a bit each.
uint candidateSlots(uint first) {
  if (push.level == frame.top) return first == 0 ? 1 : 0;
  uint bits = 0;
  for (uint i = 0; i < kCutSlotsPerThread / 8; ++i) {
    if (first + 8 * i >= push.slotCount) break;
    const uint parent = parentPlace(first + 8 * i);
    if ((opened[parent / 32] >> (parent & 31) & 1) == 0) continue;
    bits |= (kSome ? candidates[first / 8 + i] & 255 : 255u) << (8 * i);
  }
  return bits;
}

// Collects the slots of the whole workgroup, so that its threads share the tests evenly.
void listAsked(uint bits, uint firstInGroup) {
  uint place = atomicAdd(askedCount, uint(bitCount(bits)));
  for (; bits != 0; bits &= bits - 1) asked[place++] = firstInGroup + uint(findLSB(bits));
}

// Whether the block of a slot is drawn. Opens the block if its children may be drawn instead.
bool isDrawn(uint slot, inout CutCounts found) {
  const ivec3 cell = cellOfSlot(slot);
  if (any(greaterThanEqual(cell, frame.levels[push.level].dimensions))) return false;
  const uint address = blockAddress(frame.levels[push.level], cell);
  const int edge = 1 << push.level;
  const vec3 center = centerOf(cell, edge);
  if (!isOccupied(address)) {
    ++found.empty;
    return false;
  }
  if (isOutside(center, edge)) {
    ++found.outside;
    return false;
  }
  // Voxels are not tested: the test costs about as much as drawing a splat.
  if (!kVoxels && push.level < frame.top && frame.hides != 0 && isHidden(cell, push.level)) {
    ++found.hidden;
    return false;
  }
  if (push.level == frame.finest || push.level <= frame.coarsest && isSmall(center, edge)) return true;
  ++found.opened;
  const uint place = rankAt(frame.levels[push.level], address) - frame.coarseFirst;
  atomicOr(opened[place / 32], 1u << (place & 31));
  return false;
}

void main() {
  const uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
  const uint thread = gl_LocalInvocationIndex;
  const uint first = group * kCutSlotsPerGroup;
  if (first >= push.slotCount) return;
  mask[thread] = 0;
  if (thread == 0) {
    drawn = askedCount = 0;
    sums = CutCounts(0, 0, 0, 0);
  }
  barrier();
  CutCounts found = CutCounts(0, 0, 0, 0);
  listAsked(candidateSlots(first + thread * kCutSlotsPerThread), thread * kCutSlotsPerThread);
  barrier();
  for (uint i = thread; i < askedCount; i += kCutThreads)
    if (isDrawn(first + asked[i], found)) atomicOr(mask[asked[i] / 32], 1u << (asked[i] % 32));
  barrier();
  if (push.level <= frame.coarsest) masks[(push.firstGroup + group) * kCutThreads + thread] = mask[thread];
  atomicAdd(drawn, bitCount(mask[thread]));
  atomicAdd(sums.empty, found.empty);
  atomicAdd(sums.outside, found.outside);
  atomicAdd(sums.hidden, found.hidden);
  atomicAdd(sums.opened, found.opened);
  barrier();
  if (thread != 0) return;
  if (push.level <= frame.coarsest) groupCounts[push.firstGroup + group] = drawn;
  atomicAdd(counts.empty, sums.empty);
  atomicAdd(counts.outside, sums.outside);
  atomicAdd(counts.hidden, sums.hidden);
  atomicAdd(counts.opened, sums.opened);
}
