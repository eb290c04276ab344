// The levels of the octree that a dispatch computes, each from the one below. Parameters: LEVEL_STEPS_BINDING; JOINED_LEVELS, defined if
// one workgroup computes several levels. Then what is written of a level is read for the next one: declare it with LEVEL_ACCESS.
#ifndef LEVEL_STEPS_GLSL
#define LEVEL_STEPS_GLSL
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_KHR_memory_scope_semantics : require
#include "blocks.glsl"

#ifdef JOINED_LEVELS
const bool kJoined = true;
#define LEVEL_ACCESS coherent
#else
const bool kJoined = false;
#define LEVEL_ACCESS
#endif

layout(scalar, binding = LEVEL_STEPS_BINDING) uniform Steps { LevelStep steps[kMaximumLevels]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer BlockIndices { uint values[]; };

LevelStep current;  // the step to the level that is being computed

// The cell of a parent, by its place in the list of its level.
ivec3 parentCell(uint place) { return cellAt(current.parent, BlockIndices(current.parents).values[place]); }

// The parts of a level, of which each is made by one thread; the shader defines them.
uint partCount();
void makePart(uint part);

// Computes the levels of `range`. `threads` is the size of a workgroup.
void computeLevels(LevelRange range, uint threads) {
  if (!kJoined) {
    current = steps[range.first];
    const uint part = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * threads;
    if (part < partCount()) makePart(part);
    return;
  }
  for (int level = range.first; level < range.end; ++level) {
    current = steps[level];
    for (uint part = gl_LocalInvocationIndex; part < partCount(); part += threads) makePart(part);
    // The next level reads what the whole workgroup has written of this one.
    controlBarrier(gl_ScopeWorkgroup, gl_ScopeDevice, gl_StorageSemanticsBuffer, gl_SemanticsAcquireRelease);
  }
}

#endif
