#pragma once
// The table of contents of an OpenVDB file in file order, read without OpenVDB and checked against the file's
// size. OpenVDB itself reads on beyond the end of a truncated file and makes grids of whatever was in memory.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/core/stages.h"

namespace freevoxels {

struct VdbHeader {
  struct Grid {
    std::string uniqueName;  ///< as OpenVDB stores it: a shared name ends in the byte 0x1e and a number
    std::string type;        ///< "Tree_float_5_4_3"
    bool savedAsHalf = false;
    std::string parentName;         ///< unique name of the grid whose tree this one shares, or empty
    std::uint32_t compression = 0;  ///< OpenVDB's flags
    bool valuesAreHalf = false;     ///< whether the tree's values are half; OpenVDB decides by the metadata, not by savedAsHalf
    std::uint64_t start = 0, end = 0;  ///< position in the file; 0 if it was streamed out
    std::uint64_t treeStart = 0;    ///< position in the file; 0 if it is unknown
  };
  std::uint32_t formatVersion = 0;
  /// False if the file was streamed out: it can only be read as a whole, and `grids` is empty.
  bool hasOffsets = true;
  std::vector<Grid> grids;
};

/// Fails with ErrorKind::Input if `file` is missing, a folder, unreadable, not an OpenVDB file, older than
/// OpenVDB supports, shorter than its header says, or damaged in the metadata of the file or of a grid. `progress` may abandon it.
VdbHeader readVdbHeader(const std::filesystem::path& file, const Progress& progress = {});

}  // namespace freevoxels
