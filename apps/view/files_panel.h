#pragma once
// The panel "Open": a field for a file name, and recent files.

#include <string>

#include "apps/view/recent_files.h"
#include "apps/view/view_state.h"

namespace freevoxels {

class FilesPanel {
 public:
  /// Without `remembers`, opened files are not stored.
  explicit FilesPanel(bool remembers);

  /// Into the current Dear ImGui window. Ctrl+O asks for a name.
  void draw(ViewState& state);
  /// openFile; what goes wrong is said in the panel.
  void open(ViewState& state, const std::string& file);
  /// Adds a file to the list.
  void remember(const std::string& file);

 private:
  void drawRecent(ViewState& state);

  RecentFiles recent_;
  std::string name_, problem_;
};

}  // namespace freevoxels
