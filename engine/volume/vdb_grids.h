#pragma once
// Internal to the vdb_*.cpp files, as it includes OpenVDB: an open file, its grids by name, and which are
// usable.

#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>

#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "engine/volume/vdb_header.h"

namespace freevoxels {

/// Registers OpenVDB's types and turns its messages off. Must come before anything else of OpenVDB; costs nothing the second
/// time. Any thread may call it.
void initialiseOpenVdb();

/// Used by one thread at a time; threads may use objects of their own at the same time, also of one file.
class VdbFile {
 public:
  struct Entry {
    std::string name;       ///< for people, unique, one printable line: "density", "density[1]"
    std::string baseName;   ///< without the [k]
    std::string valueType;  ///< GridInfo::valueType
    std::string treeType;   ///< OpenVDB's name of the type
    std::string key;        ///< OpenVDB's name of the grid
  };

  /// Errors: readVdbHeader, and ExitCode::Input for whatever OpenVDB does not accept.
  explicit VdbFile(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return path_; }
  const std::vector<Entry>& entries() const { return entries_; }

  /// `name` as in readVdb.
  const Entry& choose(const std::string& name) const;
  /// Everything of the grid but its tree.
  openvdb::GridBase::Ptr readMetadata(const Entry& entry);
  openvdb::GridBase::Ptr read(const Entry& entry);
  /// Whether the metadata of the file or of the grid say so: Blender's world has +z up.
  bool isOfBlender(const Entry& entry);

 private:
  void listGrids();
  void readStreamedGrids();
  void checkTree(const VdbHeader::Grid& grid) const;
  /// Runs `read`, with OpenVDB's exceptions turned into one sentence, and a CrashNote in case that it crashes.
  openvdb::GridBase::Ptr guarded(const std::string& what,
                                 const std::function<openvdb::GridBase::Ptr()>& read) const;
  const Entry& chooseByDefault() const;
  const Entry& firstOf(const std::vector<const Entry*>& sameName) const;

  std::filesystem::path path_;
  openvdb::io::File file_;
  VdbHeader header_;
  std::vector<Entry> entries_;
  std::vector<openvdb::GridBase::Ptr>
      streamed_;  ///< parallel to entries_, for a file that has to be read as a whole
};

/// What grids of temperatures are called, in the order in which they are looked for.
inline constexpr std::array<const char*, 3> kTemperatureNames{"temperature", "heat", "flame"};
/// By OpenVDB's names of values.
bool isReal(const VdbFile::Entry& entry);
bool isColor(const VdbFile::Entry& entry);

/// Empty, or why a grid of this type cannot be rendered, in one clause.
std::string whyTypeUnusable(const std::string& treeType, const std::string& valueType);
/// Empty, or why a grid with this transform cannot be rendered, in one clause.
std::string whyTransformUnusable(const openvdb::math::Transform& transform);
inline constexpr const char* kEmptyGridClause = "it is empty: no voxel is active";
inline constexpr const char* kNothingInsideClause = "no voxel is inside the level set";

/// The grid itself, or a copy in float of a half or double grid; null for any other type.
openvdb::FloatGrid::ConstPtr asFloatGrid(const openvdb::GridBase::ConstPtr& grid);

}  // namespace freevoxels
