#pragma once
// Frames that real ranks of freevoxels-mpi divide on this machine.

#include <optional>
#include <string>

namespace freevoxels::bench {

/// Milliseconds of a frame of a turntable of a procedural volume at 1024 x 1024 pixels, by `ranks` processes with one device thread each:
/// drawing, adding up and writing, without what is made once for the volume. Nothing where mpirun or a freevoxels-mpi beside this program
/// is missing or fails.
std::optional<double> frameOfRealRanks(int ranks, const std::string& volume, int resolution);

}  // namespace freevoxels::bench
