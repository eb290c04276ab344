#pragma once
// Recently opened files, of this and earlier sessions.

#include <filesystem>
#include <string>
#include <vector>

namespace freevoxels {

/// ${XDG_STATE_HOME:-~/.local/state}/freevoxels/recent.json; empty where there is no home.
std::filesystem::path recentFilesPath();

class RecentFiles {
 public:
  static constexpr std::size_t kMost = 10;

  /// Reads the list; an unreadable list counts as empty. Nothing is stored if `file` is empty.
  explicit RecentFiles(std::filesystem::path file);

  /// The files, the last one first.
  const std::vector<std::string>& list() const { return list_; }
  /// Moves a file to the top, by its full path, and stores the list. If it cannot be written, the list is
  /// kept for this session only.
  void add(const std::string& opened);

 private:
  const std::filesystem::path file_;
  std::vector<std::string> list_;
};

}  // namespace freevoxels
