#pragma once
// Dialogs that choose a file to open or to save.

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/view/folder_list.h"
#include "apps/view/session_store.h"
#include "engine/vulkan/texture.h"

struct ImGuiInputTextCallbackData;

namespace freevoxels {

class FileDialog {
 public:
  /// `store` has the recent files; their thumbnails become textures of `device`.
  FileDialog(const Device& device, const SessionStore& store);

  /// Opens a dialog for a file to open: volumes, sequences, scenes, transfer functions and environments. `chosen` is called with
  /// the name, relative to the working folder where it is below it, when the user confirms.
  void open(std::function<void(const std::string&)> chosen);
  /// Opens a dialog for a file to save, which suggests `name`. `endings` are those that the list shows, such as ".png".
  void save(const char* title, const std::string& name, std::vector<std::string> endings,
            std::function<void(const std::string&)> chosen);
  /// Draws the dialog, if one is open.
  void draw();
  bool isOpen() const { return isOpen_; }

 private:
  void begin(const char* title, std::vector<std::string> endings, std::function<void(const std::string&)> chosen);
  void go(std::filesystem::path folder);
  void drawPlaces();
  void drawList();
  void drawRecent();
  bool drawTile(const std::string& file, const std::string& label);
  void drawName();
  static int followKeys(ImGuiInputTextCallbackData* data);
  void confirm(const std::string& name);
  const Texture* thumbnail(const std::string& file);

  const Device& device_;
  const SessionStore& store_;
  const std::filesystem::path start_;  ///< the working folder
  std::filesystem::path folder_;
  FolderList list_;         ///< of folder_
  std::string clicked_;     ///< the entry that was clicked last, at `clickedAt_` seconds
  double clickedAt_ = 0.0;
  std::string title_, name_, problem_;
  std::string followed_;  ///< the name whose entry was scrolled to
  std::string typed_;     ///< the part of a name to open that was typed: entries without it are not listed
  bool hasBegun_ = false;
  std::vector<std::string> endings_;
  std::function<void(const std::string&)> chosen_;
  bool saves_ = false, asked_ = false, focus_ = false, showsRecent_ = false, all_ = false, isOpen_ = false;
  std::map<std::string, std::unique_ptr<Texture>> thumbnails_;  ///< null: there is none
};

}  // namespace freevoxels
