#pragma once
// Internal to the vdb_*.cpp files, since it includes OpenVDB: an open file, its grids by name, and which of
// them can be drawn.

#include <openvdb/io/File.h>

#include <exception>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/stages.h"
#include "engine/volume/grid_names.h"
#include "engine/volume/openvdb_trees.h"
#include "engine/volume/vdb_header.h"

namespace freevoxels {

/// Registers OpenVDB's types and turns its messages off. Must come before anything else of OpenVDB; costs nothing the second
/// time. Any thread may call it.
void initialiseOpenVdb();

/// Used by one thread at a time; threads may use objects of their own at the same time, also of one file.
class VdbFile {
 public:
  struct Entry {
    std::string name;       ///< for messages and choices: unique, one printable line, such as "density" or "density[1]"
    std::string baseName;   ///< without the [k]
    std::string valueType;  ///< GridInfo::valueType
    std::string treeType;   ///< OpenVDB's name of the type
    std::string key;        ///< OpenVDB's name of the grid
    /// The place among OpenVDB's list of all grids, where by the key it finds another grid or none, or for an instance another tree.
    std::optional<std::size_t> place = std::nullopt;
  };

  struct Reading {
    /// Whether the leaves of grids that are read leave their values in the file, as long as the VdbFile lives, where OpenVDB can do that.
    bool delaysValues = false;
    Progress progress = {};  ///< may abandon read()
  };

  /// Fails as readVdbHeader does, and with ErrorKind::Input if OpenVDB rejects the file.
  explicit VdbFile(const std::filesystem::path& path, const Reading& reading);
  explicit VdbFile(const std::filesystem::path& path) : VdbFile(path, Reading{}) {}
  bool delaysValues() const { return delaysValues_; }

  const std::filesystem::path& path() const { return path_; }
  const std::vector<Entry>& entries() const { return entries_; }

  /// Chooses a grid by a name. Adds a warning if several grids have the name.
  const Entry& choose(const std::string& name);
  /// Whether a grid has the name.
  bool has(const std::string& name) const;
  /// Chooses a grid of densities as readVdb does; null where the name is empty and the file has temperatures alone, or where the grid of
  /// the name may be missing and is.
  const Entry* chooseDensity(const std::string& name, bool mayBeMissing);
  /// The first grid by the usual names of a role, which `suits`; null if there is none.
  const Entry* findByRole(GridRole role, const std::function<bool(const Entry&)>& suits);
  /// Reads the grid without its tree.
  openvdb::GridBase::Ptr readMetadata(const Entry& entry);
  /// Reads all grids of the file where OpenVDB cannot find this one by its key.
  openvdb::GridBase::Ptr read(const Entry& entry);
  /// For Volume::warnings.
  const std::vector<std::string>& warnings() const { return warnings_; }
  /// Whether the metadata of the file or of the grid say that Blender wrote it: its world has +z up.
  bool isFromBlender(const Entry& entry);

 private:
  void listGrids();
  void readStreamedGrids();
  void checkTree(const VdbHeader::Grid& grid) const;
  openvdb::GridBase::Ptr readAlone(const Entry& entry);
  /// Runs `read`, with OpenVDB's exceptions turned into one sentence, and a CrashNote in case that it crashes.
  void guarded(const std::string& what, const std::function<void()>& read) const;
  /// The place of a grid in entries_, and in header_.grids or streamed_.
  std::size_t indexOf(const Entry& entry) const { return std::size_t(&entry - entries_.data()); }
  const Entry* chooseDensityByDefault();
  /// `name` is what they have in common.
  const Entry& firstOf(const std::string& name, const std::vector<const Entry*>& sameName);

  std::filesystem::path path_;
  bool delaysValues_ = false;
  Progress progress_;  ///< empty, or notes in abandoned_ what it throws
  mutable std::exception_ptr abandoned_;
  openvdb::io::File file_;
  VdbHeader header_;
  std::vector<Entry> entries_;
  std::vector<std::string> warnings_;
  std::vector<openvdb::GridBase::Ptr> streamed_;  ///< all grids of a file that can only be read as a whole
  std::vector<openvdb::GridBase::Ptr> all_;       ///< in OpenVDB's order, once one was read that has a place
};

/// Text from a file in a form that fits into a sentence: one printable line of limited length.
std::string oneLine(const std::string& text);

/// Whether the grid has real numbers, whole numbers (of which booleans and masks are 0 and 1), or colours, by OpenVDB's names of types.
bool isScalar(const VdbFile::Entry& entry);
bool isWhole(const VdbFile::Entry& entry);
bool isColor(const VdbFile::Entry& entry);

/// Why a grid of this type cannot be drawn, in one clause; empty if it can.
std::string whyTypeUnusable(const std::string& treeType, const std::string& valueType);
/// Why a grid with this transform cannot be drawn, in one clause; empty if it can.
std::string whyTransformUnusable(const openvdb::math::Transform& transform);
inline constexpr const char* kEmptyGridClause = "it is empty: no voxel is active";
inline constexpr const char* kNothingInsideClause = "no voxel is inside the level set";

/// The grid itself if it is a float grid, a float copy of one of other numbers, or null for any other type.
openvdb::FloatGrid::ConstPtr asFloatGrid(const openvdb::GridBase::ConstPtr& grid);

}  // namespace freevoxels
