// The values of occupied blocks by rank (engine/octree/device_volume.h), at device addresses, as devices bind buffers only up to a
// size. Parameters: STORES, an expression for the BlockStores; STORES_ACCESS, coherent where invocations read what others wrote.
#ifndef STORES_GLSL
#define STORES_GLSL
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#include "interface.h"
#ifndef STORES
#error "Define STORES, an expression for the BlockStores, before including stores.glsl."
#endif

#ifndef STORES_ACCESS
#define STORES_ACCESS
#endif

layout(buffer_reference, scalar, buffer_reference_align = 4) STORES_ACCESS buffer FloatStore { float values[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) STORES_ACCESS buffer WordStore { uint values[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) STORES_ACCESS buffer PairStore { uvec2 values[]; };

float storedExtinction(uint rank) { return FloatStore(STORES.extinction).values[rank]; }
uint storedEmission(uint rank) { return WordStore(STORES.emission).values[rank]; }
uint storedColor(uint rank) { return WordStore(STORES.colors).values[rank]; }  // of a voxel
uvec2 storedBlockColor(uint place) { return PairStore(STORES.blockColors).values[place]; }

#endif
