#pragma once
// What the dialog for files lists of a folder.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace freevoxels {

class FolderList {
 public:
  static constexpr const char* kThisFolder = ".";  ///< the name of the entry that opens the folder itself
  enum class Column { Name, Size, Changed };

  struct Entry {
    std::string name;   ///< a folder's ends in "/"
    std::string shown;  ///< with the number of frames of a sequence
    std::uintmax_t bytes = 0;
    std::filesystem::file_time_type time;
    bool isFolder() const { return name.ends_with('/'); }
    /// Whether a part of what is shown is this, whatever the case of its letters.
    bool contains(const std::string& part) const;
  };

  /// Lists the folders, and the files with these endings, or if there are none all of them. Where files are to be opened, frames of a
  /// sequence are one entry besides, and so is the folder if its files are the slices of a volume. Returns the sentence for a folder that
  /// cannot be read, whose list stays that of the folder before.
  std::string read(const std::filesystem::path& folder, const std::vector<std::string>& endings, bool saves);
  /// Sorts the entries: the folder itself first, then folders, which have names alone, then files.
  void sortBy(Column column, bool descends);

  const std::vector<Entry>& entries() const { return entries_; }
  bool hasFiles() const;
  /// Whether the folder can be opened as a volume.
  bool isVolume() const { return isVolume_; }
  /// The number of files with other endings.
  std::size_t hidden() const { return hidden_; }

  /// The name of the entry that is `step` after the one of this name, among those that contain `part`; the first or last one if there is
  /// none of this name.
  std::string next(const std::string& part, const std::string& name, int step) const;
  /// What all entries have in common that begin with the name, whatever the case of its letters; the name itself if there is none.
  std::string completed(const std::string& name) const;

  /// Whether a folder is opened like a file.
  static bool isOpenedLikeAFile(const std::filesystem::path& folder);

 private:
  void addFiles(const std::vector<std::filesystem::directory_entry>& files, bool saves);

  std::vector<Entry> entries_;
  std::size_t hidden_ = 0;
  bool isVolume_ = false;
  Column sortedBy_ = Column::Name;
  bool descends_ = false;
};

}  // namespace freevoxels
