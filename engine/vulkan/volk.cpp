// volk is a single source file; this translation unit is where it is compiled.
#define VOLK_IMPLEMENTATION
#include <volk.h>
