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
    std::string parentName;         ///< unique name of the grid whose tree this one shares, or empty
    std::uint32_t compression = 0;  ///< OpenVDB's flags
    bool valuesAreHalf = false;     ///< in the tree; OpenVDB goes by the metadata here, not by savedAsHalf
    std::uint64_t treeStart = 0;    ///< position in the file; 0 where it cannot be told
  };
  std::uint32_t formatVersion = 0;
  /// False for a file that was streamed out: it can only be read as a whole, and `grids` is empty.
  bool hasOffsets = true;
  std::vector<Grid> grids;
};

/// Fails with ExitCode::Input where `file` is missing, a folder, unreadable, not an OpenVDB file, older than
/// OpenVDB supports, shorter than its own header says, or damaged in the metadata of the file or of a grid.
VdbHeader readVdbHeader(const std::filesystem::path& file);

}  // namespace freevoxels
