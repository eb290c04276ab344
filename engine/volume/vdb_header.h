#pragma once
// The table of contents of an OpenVDB file, read without OpenVDB: in file order, and checked against the
// file's size. OpenVDB itself reads on past the end of a truncated file and makes grids from what was in
// memory.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace freevoxels {

struct VdbHeader {
  struct Grid {
    std::string uniqueName;  ///< as OpenVDB stores it: a shared name ends in the byte 0x1e and a number
    std::string type;        ///< "Tree_float_5_4_3"
    bool savedAsHalf = false;
  };
  std::uint32_t formatVersion = 0;
  /// False for a file that was streamed out: it can only be read as a whole, and `grids` is empty.
  bool hasOffsets = true;
  std::vector<Grid> grids;
};

/// Fails with ExitCode::Input where `file` is missing, a folder, unreadable, not an OpenVDB file, older than
/// OpenVDB supports or shorter than its own header says.
VdbHeader readVdbHeader(const std::filesystem::path& file);

}  // namespace freevoxels
