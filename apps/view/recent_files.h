#pragma once
// What was opened last, in this and earlier windows.

#include <filesystem>
#include <string>
#include <vector>

namespace freevoxels {

/// ${XDG_STATE_HOME:-~/.local/state}/freevoxels/recent.json; empty where there is no home.
std::filesystem::path recentFilesPath();

class RecentFiles {
 public:
  static constexpr std::size_t kMost = 10;

  /// Reads the list; one that cannot be read is empty. Nothing is remembered where `file` is empty.
  explicit RecentFiles(std::filesystem::path file);

  /// The last one first.
  const std::vector<std::string>& list() const { return list_; }
  /// Puts it on top, by its full path, and keeps the list. A disk that does not take it is no reason to
  /// bother anyone: the list is then of this window alone.
  void add(const std::string& opened);

 private:
  const std::filesystem::path file_;
  std::vector<std::string> list_;
};

}  // namespace freevoxels
