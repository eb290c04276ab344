// The medium of occupied blocks by rank (engine/octree/device_volume.h), at device addresses, because the
// size of a bound buffer is limited. Include after interface.h. STORES is the BlockStores.
#ifndef FREEVOXELS_STORES_GLSL
#define FREEVOXELS_STORES_GLSL
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer FloatStore { float values[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer WordStore { uint values[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer PairStore { uvec2 values[]; };

float storedExtinction(uint rank) { return FloatStore(STORES.extinction).values[rank]; }
uint storedEmission(uint rank) { return WordStore(STORES.emission).values[rank]; }
uint storedColor(uint rank) { return WordStore(STORES.colors).values[rank]; }  // of a voxel
uvec2 storedBlockColor(uint place) { return PairStore(STORES.blockColors).values[place]; }

#endif
