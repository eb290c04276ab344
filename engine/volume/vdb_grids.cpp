#include "engine/volume/vdb_grids.h"

#ifdef FREEVOXELS_LOG4CPLUS
#include <log4cplus/logger.h>
#endif
#include <openvdb/io/Stream.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <map>
#include <new>
#include <span>
#include <utility>

#include "engine/core/crash_note.h"
#include "engine/core/error.h"
#include "engine/core/printable.h"
#include "engine/volume/vdb_grid_reader.h"
#include "engine/volume/vdb_tree_check.h"

namespace freevoxels {

std::string oneLine(const std::string& text) {
  constexpr std::size_t kLongest = 200;
  return printablePart(text, kLongest);
}

namespace {

namespace fs = std::filesystem;
using openvdb::GridBase;
using openvdb::io::GridDescriptor;

/// Opens with or without delayed loading, which only costs time if every value is needed, and which newer versions of
/// OpenVDB do not have. Returns whether there is any.
template <typename File>
bool openFile(File& file, bool delaysValues) {
  if constexpr (requires { file.open(false); }) {
    file.setCopyMaxBytes(0);  // it is read in place
    file.open(delaysValues);
    return delaysValues;
  } else {
    file.open();
    return false;
  }
}

template <typename Stream>
std::vector<GridBase::Ptr> readWholeStream(std::istream& input) {
  if constexpr (std::is_constructible_v<Stream, std::istream&, bool>)
    return *Stream(input, false).getGrids();
  else
    return *Stream(input).getGrids();
}

std::string valueTypeOf(const std::string& treeType, bool savedAsHalf) {
  const std::size_t begin = treeType.find('_');
  const std::size_t end = treeType.find('_', begin + 1);
  if (!treeType.starts_with("Tree_") || end == std::string::npos) return oneLine(treeType);
  const std::string value = treeType.substr(begin + 1, end - begin - 1);
  if (value.starts_with("ptdata")) return "point data";
  if (value.starts_with("ptidx")) return "point index";
  if (value == "float" && savedAsHalf) return "half";
  return oneLine(value);
}

std::string listOf(const std::vector<VdbFile::Entry>& entries) {
  constexpr std::size_t kMaxListed = 20;
  std::string list;
  for (const VdbFile::Entry& entry : std::span(entries).first(std::min(entries.size(), kMaxListed)))
    list += fmt::format("{}'{}' ({})", list.empty() ? "" : ", ", entry.name, entry.valueType);
  if (entries.size() > kMaxListed) list += fmt::format(" and {} more", entries.size() - kMaxListed);
  return list.empty() ? "none" : list;
}

std::string lowerCase(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return text;
}

/// Distinguishes grids of equal name by OpenVDB's numbers if there are any, else by their order in the file.
void nameEntries(std::vector<VdbFile::Entry>& entries) {
  std::map<std::string, int> uses, shown;
  for (VdbFile::Entry& entry : entries) {
    entry.name = oneLine(entry.key);
    ++uses[entry.name];
  }
  for (VdbFile::Entry& entry : entries) {
    const std::string name = entry.name;
    if (uses[name] == 1) continue;
    do entry.name = fmt::format("{}[{}]", name, shown[name]++);
    while (uses.contains(entry.name));  // another grid has that name by itself
    uses[entry.name] = 1;
  }
}

/// Which grid OpenVDB (io::File) finds by a name. It is another one where a grid's own name looks like that of the second of several:
/// "density[1]", or where two have the same name in the file.
class GridSearch {
 public:
  explicit GridSearch(const std::vector<VdbHeader::Grid>& grids) {
    for (std::size_t i = 0; i < grids.size(); ++i) {
      SameName& same = byName_[GridDescriptor::stripSuffix(grids[i].uniqueName)];
      same.byUniqueName.emplace(grids[i].uniqueName, i);
      same.all.push_back(i);
    }
  }
  std::optional<std::size_t> find(const std::string& name) const {
    const std::string uniqueName = GridDescriptor::stringAsUniqueName(name);
    auto same = byName_.find(name);
    if (same == byName_.end()) same = byName_.find(GridDescriptor::stripSuffix(uniqueName));
    if (same == byName_.end()) return std::nullopt;
    if (name == uniqueName) return same->second.all.front();
    std::optional<std::size_t> first;
    for (const std::string& wanted : {uniqueName, name})
      if (const auto found = same->second.byUniqueName.find(wanted); found != same->second.byUniqueName.end())
        first = std::min(first.value_or(found->second), found->second);
    return first;
  }
  /// The first grid with this name in the file.
  std::optional<std::size_t> named(const std::string& uniqueName) const {
    const auto same = byName_.find(GridDescriptor::stripSuffix(uniqueName));
    if (same == byName_.end() || !same->second.byUniqueName.contains(uniqueName)) return std::nullopt;
    return same->second.byUniqueName.at(uniqueName);
  }
  /// The grids in the order in which OpenVDB reads all of them.
  std::vector<std::size_t> order() const {
    std::vector<std::size_t> order;
    for (const auto& [name, same] : byName_) order.insert(order.end(), same.all.begin(), same.all.end());
    return order;
  }

 private:
  struct SameName {
    std::map<std::string, std::size_t> byUniqueName;  ///< the first of each
    std::vector<std::size_t> all;
  };
  std::map<std::string, SameName> byName_;
};

}  // namespace

void initialiseOpenVdb() {
  static const bool once = [] {
    openvdb::initialize();
#ifdef FREEVOXELS_LOG4CPLUS
    // What OpenVDB warns of on the terminal is either of no consequence or fails later, in a sentence.
    log4cplus::Logger::getInstance(LOG4CPLUS_TEXT("openvdb")).setLogLevel(log4cplus::OFF_LOG_LEVEL);
#endif
    return true;
  }();
  static_cast<void>(once);
}

VdbFile::VdbFile(const fs::path& path, const Reading& reading) : path_(path), file_(path.string()), header_(readVdbHeader(path, reading.progress)) {
  if (reading.progress)
    progress_ = [this, report = reading.progress](std::string_view stage, double fraction) {
      try {
        report(stage, fraction);
      } catch (...) {
        abandoned_ = std::current_exception();
        throw;
      }
    };
  initialiseOpenVdb();
  if (header_.hasOffsets) {
    guarded("the header", [&] { delaysValues_ = openFile(file_, reading.delaysValues); });
    listGrids();
  } else {
    readStreamedGrids();
  }
}

void VdbFile::listGrids() {
  for (const VdbHeader::Grid& grid : header_.grids)
    entries_.push_back({.baseName = oneLine(GridDescriptor::stripSuffix(grid.uniqueName)),
                        .valueType = valueTypeOf(grid.type, grid.savedAsHalf),
                        .treeType = grid.type,
                        .key = GridDescriptor::nameAsString(grid.uniqueName)});
  nameEntries(entries_);
  const GridSearch search(header_.grids);
  const std::vector<std::size_t> order = search.order();
  for (std::size_t place = 0; place < order.size(); ++place) {
    const std::string& parent = header_.grids[order[place]].parentName;
    const bool findsParent = parent.empty() || search.find(GridDescriptor::nameAsString(parent)) == search.named(parent);
    if (Entry& entry = entries_[order[place]]; search.find(entry.key) != order[place] || !findsParent) entry.place = place;
  }
}

void VdbFile::readStreamedGrids() {
  guarded("its grids", [&] {
    ReportingFile input(path_, fs::file_size(path_), progress_);  // without exceptions OpenVDB reads on beyond the end of the file
    streamed_ = readWholeStream<openvdb::io::Stream>(input);
  });
  for (const GridBase::Ptr& grid : streamed_)
    entries_.push_back({.baseName = oneLine(grid->getName()),
                        .valueType = valueTypeOf(grid->type(), grid->saveFloatAsHalf()),
                        .treeType = grid->type(),
                        .key = grid->getName()});
  nameEntries(entries_);
}

void VdbFile::guarded(const std::string& what, const std::function<void()>& read) const {
  try {
    const CrashNote note(fmt::format("cannot read {} of '{}': the file is damaged; copy or download it again", what,
                                     printable(path_.string())));
    read();
  } catch (const std::bad_alloc&) {
    fail(ErrorKind::OutOfMemory,
         "not enough memory to read {} of '{}'; free some, or crop or resample the volume", what,
         path_.string());
  } catch (const std::ios_base::failure&) {
    fail(ErrorKind::Input, "cannot read {} of '{}': the file ends too early; copy or download it again", what,
         path_.string());
  } catch (const std::exception& e) {
    if (abandoned_) std::rethrow_exception(std::exchange(abandoned_, nullptr));
    fail(ErrorKind::Input, "cannot read {} of '{}': {}; the file may be damaged", what, path_.string(),
         oneLine(e.what()));
  }
}

const VdbFile::Entry& VdbFile::choose(const std::string& name) {
  if (entries_.empty()) fail(ErrorKind::Input, "'{}' holds no grids; choose another file", path_.string());
  std::vector<const Entry*> sameName;
  for (const Entry& entry : entries_) {
    if (entry.name == name) return entry;
    if (entry.baseName == name || oneLine(entry.key) == name) sameName.push_back(&entry);
  }
  if (sameName.empty())
    fail(ErrorKind::Input, "'{}' has no grid '{}'; choose one of: {}", path_.string(), oneLine(name),
         listOf(entries_));
  return firstOf(oneLine(name), sameName);
}

bool VdbFile::has(const std::string& name) const {
  return std::ranges::any_of(
      entries_, [&](const Entry& entry) { return entry.name == name || entry.baseName == name || oneLine(entry.key) == name; });
}

const VdbFile::Entry* VdbFile::chooseDensity(const std::string& name, bool mayBeMissing) {
  if (!name.empty() && mayBeMissing && !has(name)) return nullptr;
  if (!name.empty() || entries_.empty()) return &choose(name);
  return chooseDensityByDefault();
}

const VdbFile::Entry* VdbFile::findByRole(GridRole role, const std::function<bool(const Entry&)>& suits) {
  std::vector<const Entry*> best;
  int rank = 0;
  for (const Entry& entry : entries_) {
    const NamedRole named = roleOfName(entry.baseName);
    if (named.role != role || !suits(entry) || (!best.empty() && named.rank > rank)) continue;
    if (!best.empty() && named.rank < rank) best.clear();
    rank = named.rank;
    best.push_back(&entry);
  }
  // "density" before "Density" and "DENSITY".
  const auto isLower = [](const Entry* entry) { return entry->baseName == lowerCase(entry->baseName); };
  if (std::ranges::any_of(best, isLower)) std::erase_if(best, std::not_fn(isLower));
  return best.empty() ? nullptr : &firstOf(best.front()->baseName, best);
}

const VdbFile::Entry* VdbFile::chooseDensityByDefault() {
  if (const Entry* density = findByRole(GridRole::Density, isScalar)) return density;
  std::vector<const Entry*> scalars, possible;
  bool hasTemperatures = false;
  for (const Entry& entry : entries_) {
    if (!isScalar(entry)) continue;
    scalars.push_back(&entry);
    const GridRole role = roleOfName(entry.baseName).role;
    hasTemperatures = hasTemperatures || role == GridRole::Temperature;
    if (role == GridRole::Unknown) possible.push_back(&entry);
  }
  if (possible.size() == 1) return possible.front();
  if (possible.empty() && hasTemperatures) return nullptr;
  if (scalars.size() == 1) return scalars.front();
  std::vector<const Entry*> labels;
  for (const Entry& entry : entries_)
    if (isWhole(entry)) labels.push_back(&entry);
  if (scalars.empty() && labels.size() == 1) return labels.front();
  if (scalars.empty() && labels.size() > 1)
    fail(ErrorKind::Input, "'{}' has several grids of whole numbers; choose one with {}: {}", path_.string(), Parameter("grid"),
         listOf(entries_));
  if (scalars.empty() && entries_.size() == 1) return &entries_.front();  // readVdb will say why it cannot be drawn
  if (scalars.empty()) fail(ErrorKind::Input, "'{}' has no float grid, only: {}; choose another file", path_.string(), listOf(entries_));
  fail(ErrorKind::Input,
       "'{}' has several float grids and none is named 'density'; choose one with {}: {}", path_.string(),
       Parameter("grid"), listOf(entries_));
}

const VdbFile::Entry& VdbFile::firstOf(const std::string& name, const std::vector<const Entry*>& sameName) {
  if (sameName.size() > 1) {
    std::string others;
    for (const Entry* entry : sameName)
      if (entry != sameName.front()) others += fmt::format("{}'{}'", others.empty() ? "" : ", ", entry->name);
    warnings_.push_back(fmt::format("'{}' has {} grids named '{}': using '{}'; {} chooses {}", path_.string(), sameName.size(),
                                    name, sameName.front()->name, Parameter("grid"), others));
  }
  return *sameName.front();
}

GridBase::Ptr VdbFile::readMetadata(const Entry& entry) {
  if (!streamed_.empty()) return streamed_[indexOf(entry)];
  GridBase::Ptr grid;
  guarded(fmt::format("grid '{}'", entry.name), [&] {
    grid = entry.place ? file_.readAllGridMetadata()->at(*entry.place) : file_.readGridMetadata(entry.key);
  });
  return grid;
}

bool VdbFile::isFromBlender(const Entry& entry) {
  const GridBase::Ptr grid = readMetadata(entry);
  const auto creatorIsBlender = [](const openvdb::MetaMap& metadata) {
    const auto creator = metadata.getMetadata<openvdb::StringMetadata>("creator");
    return creator && creator->value().starts_with("Blender");
  };
  const openvdb::MetaMap::Ptr ofFile = streamed_.empty() ? file_.getMetadata() : nullptr;
  const auto isLocal = grid->getMetadata<openvdb::BoolMetadata>(GridBase::META_IS_LOCAL_SPACE);
  // Blender's smoke caches are the only grids that claim to be in local space; its fluid caches have a base
  // resolution.
  return (ofFile && creatorIsBlender(*ofFile)) || creatorIsBlender(*grid) || (isLocal && isLocal->value()) ||
         (*grid)["file_base_resolution"] != nullptr;
}

GridBase::Ptr VdbFile::read(const Entry& entry) {
  if (!streamed_.empty()) return streamed_[indexOf(entry)];
  if (entry.place) {
    if (all_.empty()) {
      for (const VdbHeader::Grid& one : header_.grids) checkTree(one);
      guarded("its grids", [&] { all_ = *file_.getGrids(); });
    }
    return all_.at(*entry.place);
  }
  checkTree(header_.grids[indexOf(entry)]);
  GridBase::Ptr grid;
  guarded(fmt::format("grid '{}'", entry.name), [&] { grid = readAlone(entry); });
  return grid;
}

GridBase::Ptr VdbFile::readAlone(const Entry& entry) {
  const VdbHeader::Grid& grid = header_.grids[indexOf(entry)];
  if (!progress_ || delaysValues_ || !grid.parentName.empty()) return file_.readGrid(entry.key);
  return readVdbGrid(path_, grid, progress_);
}

void VdbFile::checkTree(const VdbHeader::Grid& grid) const {
  const auto parent = std::ranges::find(header_.grids, grid.parentName, &VdbHeader::Grid::uniqueName);
  const bool isShared = !grid.parentName.empty() && parent != header_.grids.end();
  VdbReader reader(path_);
  checkVdbTree(reader, isShared ? *parent : grid, progress_);
}

}  // namespace freevoxels
