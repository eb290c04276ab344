#pragma once
// What the viewer remembers between sessions: recently opened files with their thumbnails, camera bookmarks, the last scene.

#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "engine/image/image.h"
#include "engine/scene/camera.h"

namespace freevoxels {

/// ${XDG_STATE_HOME:-~/.local/state}/freevoxels; empty where there is no home.
std::filesystem::path sessionFolder();

/// Several processes may use one folder: a change reads what the others have written, under a lock, and replaces the file as a
/// whole. What cannot be read counts as empty; what cannot be written is kept for this session only.
class SessionStore {
 public:
  static constexpr std::size_t kMaxRecent = 10;
  static constexpr glm::ivec2 kThumbnailSize{96, 72};

  /// Nothing is read and stored if `folder` is empty.
  explicit SessionStore(std::filesystem::path folder);

  /// Full paths of opened files, the last one first.
  const std::vector<std::string>& recent() const { return recent_; }
  /// Moves a file to the top of the list.
  void remember(const std::string& opened);

  /// The hint on how to turn is shown until the user has turned once.
  bool knowsHowToTurn() const { return knowsHowToTurn_; }
  void setKnowsHowToTurn();

  /// The cameras that were stored for a volume, by its name as it is opened.
  std::vector<Camera> bookmarks(const std::string& volume) const;
  void setBookmarks(const std::string& volume, const std::vector<Camera>& cameras);

  /// The scene file of the last session; empty if nothing is stored.
  std::filesystem::path lastScene() const { return folder_.empty() ? folder_ : folder_ / "last_scene.json"; }
  /// The PNG of a recent file, of kThumbnailSize, which may not exist; empty if nothing is stored.
  std::filesystem::path thumbnail(const std::string& file) const;
  /// Writes it from an image of any size, cropped to the thumbnail's proportions.
  void storeThumbnail(const std::string& file, const Image& image, const DisplayLook& look) const;

 private:
  void take(const nlohmann::json& root);
  void update(const std::function<void(nlohmann::json&)>& change);

  const std::filesystem::path folder_;
  std::vector<std::string> recent_;
  bool knowsHowToTurn_ = false;
  std::vector<std::pair<std::string, std::vector<Camera>>> bookmarks_;
};

}  // namespace freevoxels
