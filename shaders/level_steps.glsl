// The steps from level to level of the octree that a dispatch takes. Parameters: LEVEL_STEPS_BINDING; and the constant kSeveral, whether
// one workgroup computes several levels, each from what it wrote of the one below.
#ifndef LEVEL_STEPS_GLSL
#define LEVEL_STEPS_GLSL
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#include "blocks.glsl"

layout(scalar, binding = LEVEL_STEPS_BINDING) uniform Steps { LevelStep steps[kMaximumLevels]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer BlockIndices { uint values[]; };

LevelStep current;  // the step that is being taken

// The cell of a parent, by its place in the list of its level.
ivec3 parentCell(uint place) { return cellAt(current.parent, BlockIndices(current.parents).values[place]); }

// The parts of a level, a thread each; the shader defines them.
uint partCount();
void makePart(uint part);

// Takes the steps to the levels of a dispatch of workgroups of `threads` threads.
void takeSteps(LevelRange range, uint threads) {
  if (!kSeveral) {
    current = steps[range.first];
    const uint part = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * threads;
    if (part < partCount()) makePart(part);
    return;
  }
  for (int level = range.first; level < range.end; ++level) {
    current = steps[level];
    for (uint part = gl_LocalInvocationIndex; part < partCount(); part += threads) makePart(part);
    // Until the workgroup has written the level.
    memoryBarrierBuffer();
    barrier();
  }
}

#endif
