#include "apps/view/folder_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <optional>
#include <set>
#include <utility>

#include "apps/common/sequence.h"
#include "apps/view/opened_file.h"
#include "apps/view/typed_text.h"
#include "engine/volume/scan_file.h"

namespace freevoxels {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxFiles = 20000;  // that are listed

/// How many files of a folder are the slices of volumes, which open by its name: TIFF and DICOM, of which the latter often have no ending.
std::size_t slicesAmong(const std::vector<fs::path>& files) {
  constexpr std::ptrdiff_t kTried = 3;  // of files whose endings say nothing
  const auto slices = std::ranges::count_if(files, [](const fs::path& file) { return hasEnding(file, {".tif", ".tiff", ".dcm", ".ima"}); });
  if (slices > 0) return std::size_t(slices);
  std::vector<fs::path> unknown;
  std::ranges::copy_if(files, std::back_inserter(unknown), [](const fs::path& file) { return !hasScanEnding(file); });
  return std::ranges::any_of(unknown.begin(), unknown.begin() + std::min(kTried, std::ssize(unknown)), isScanFile) ? unknown.size() : 0;
}

}  // namespace

bool FolderList::Entry::contains(const std::string& part) const {
  return containsIgnoringCase(shown, part);
}

bool FolderList::isOpenedLikeAFile(const fs::path& folder) {
  return hasEnding(folder, {".zarr"});
}

bool FolderList::hasFiles() const {
  return std::ranges::any_of(entries_, [](const Entry& entry) { return !entry.isFolder(); });
}

std::string FolderList::read(const fs::path& folder, const std::vector<std::string>& endings, bool saves) {
  std::vector<Entry> folders;
  std::vector<fs::directory_entry> files;
  std::vector<fs::path> all;
  std::size_t hidden = 0;
  std::error_code problem;
  for (fs::directory_iterator at(folder, problem), end; !problem && at != end && files.size() < kMaxFiles; at.increment(problem)) {
    std::error_code unknown;
    const std::string name = at->path().filename().string();
    if (name.starts_with('.')) continue;
    if (at->is_directory(unknown) && !isOpenedLikeAFile(at->path()))
      folders.push_back({.name = name + "/", .shown = name + "/", .time = {}});
    else if (endings.empty() || hasEnding(at->path(), endings))
      files.push_back(*at);
    else
      ++hidden;
    if (at->is_regular_file(unknown)) all.push_back(at->path());
  }
  if (problem) return fmt::format("cannot read the folder '{}': {}", folder.string(), problem.message());
  hidden_ = hidden;
  entries_ = std::move(folders);
  const std::size_t slices = saves ? 0 : slicesAmong(all);
  isVolume_ = slices > 1;
  if (isVolume_)
    entries_.push_back({.name = kThisFolder, .shown = fmt::format("This folder, as a volume of {} slices", slices), .time = {}});
  std::ranges::sort(files, {}, [](const fs::directory_entry& file) { return file.path(); });
  addFiles(files, saves);
  sortBy(sortedBy_, descends_);
  return "";
}

void FolderList::sortBy(Column column, bool descends) {
  sortedBy_ = column;
  descends_ = descends;
  const auto rank = [](const Entry& entry) { return entry.name == kThisFolder ? 0 : entry.isFolder() ? 1 : 2; };
  const auto isBefore = [&](const Entry& a, const Entry& b) {
    if (rank(a) != rank(b)) return rank(a) < rank(b);
    const Entry &first = descends_ ? b : a, &second = descends_ ? a : b;
    if (!a.isFolder() && sortedBy_ == Column::Size && a.bytes != b.bytes) return first.bytes < second.bytes;
    if (!a.isFolder() && sortedBy_ == Column::Changed && a.time != b.time) return first.time < second.time;
    return first.name < second.name;
  };
  std::ranges::stable_sort(entries_, isBefore);
}

std::string FolderList::next(const std::string& part, const std::string& name, int step) const {
  std::vector<const Entry*> listed;
  for (const Entry& entry : entries_)
    if (entry.contains(part)) listed.push_back(&entry);
  if (listed.empty()) return name;
  const auto current = std::ranges::find(listed, name, &Entry::name);
  const auto count = int(listed.size());
  const int number = current == listed.end() ? (step > 0 ? 0 : count - 1) : std::clamp(int(current - listed.begin()) + step, 0, count - 1);
  return listed[std::size_t(number)]->name;
}

std::string FolderList::completed(const std::string& name) const {
  std::optional<std::string> common;
  for (const Entry& entry : entries_) {
    if (!startsIgnoringCase(entry.name, name)) continue;
    if (!common) common = entry.name;
    std::size_t same = 0;
    while (same < common->size() && same < entry.name.size() && (*common)[same] == entry.name[same]) ++same;
    common->resize(same);
  }
  return common && common->size() > name.size() ? *common : name;
}

/// The frames of a sequence are one entry beside the files themselves.
void FolderList::addFiles(const std::vector<fs::directory_entry>& files, bool saves) {
  std::set<std::string> framesOfSome;
  for (const fs::directory_entry& file : files) {
    const std::string name = file.path().filename().string(), stem = stemOf(file.path());
    std::error_code unknown;
    const std::uintmax_t bytes = file.is_regular_file(unknown) ? file.file_size(unknown) : 0;
    const fs::file_time_type time = file.last_write_time(unknown);
    const bool isNumbered = !saves && mayBeFrame(file.path()) && !stem.empty() && std::isdigit(stem.back()) != 0;
    if (isNumbered && !framesOfSome.contains(file.path().string()))
      if (const std::optional<Sequence> sequence = sequenceAround(file.path().string())) {
        framesOfSome.insert(sequence->files.begin(), sequence->files.end());
        const std::string pattern = fs::path(sequence->pattern).filename().string();
        entries_.push_back({.name = pattern, .shown = fmt::format("{}  ({} frames)", pattern, sequence->files.size()), .time = time});
      }
    entries_.push_back({.name = name, .shown = name, .bytes = bytes, .time = time});
  }
}

}  // namespace freevoxels
