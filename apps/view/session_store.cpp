#include "apps/view/session_store.h"

#include <fcntl.h>
#include <spdlog/spdlog.h>
#include <sys/file.h>
#include <unistd.h>
#include <xxhash.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "apps/common/failure.h"
#include "engine/core/atomic_file.h"
#include "engine/core/json_file.h"
#include "engine/description/scene_description.h"

namespace freevoxels {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr const char* kStateFile = "viewer.json";

/// An advisory lock as long as it exists; none where it cannot be made.
class FileLock {
 public:
  explicit FileLock(const fs::path& file) : file_(open(file.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0600)) {
    if (file_ >= 0) flock(file_, LOCK_EX);
  }
  ~FileLock() {
    if (file_ >= 0) close(file_);
  }
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  const int file_;
};

Json readState(const fs::path& file) {
  std::error_code unknown;
  if (!fs::exists(file, unknown)) return Json::object();
  try {
    Json root = readJson("state of the viewer", file);
    if (root.is_object()) return root;
  } catch (const Error& error) {
    spdlog::debug("{}", withOptions(error));
  }
  return Json::object();
}

Json vectorJson(glm::dvec3 value) {
  return {value.x, value.y, value.z};
}

Json cameraJson(const Camera& camera) {
  return {{"position", vectorJson(camera.position)}, {"look_at", vectorJson(camera.lookAt)}, {"up", vectorJson(camera.up)},
          {"fov", camera.verticalFov}, {"orthographic", camera.orthographic}, {"height", camera.orthographicHeight}};
}

/// Throws Json::exception for anything else.
Camera cameraOf(const Json& json) {
  const auto vector = [&](const char* key) {
    const auto value = json.at(key).get<std::vector<double>>();
    return glm::dvec3(value.at(0), value.at(1), value.at(2));
  };
  Camera camera;
  camera.position = vector("position");
  camera.lookAt = vector("look_at");
  camera.up = vector("up");
  camera.verticalFov = json.at("fov");
  camera.orthographic = json.at("orthographic");
  camera.orthographicHeight = json.at("height");
  checkCamera(camera);
  return camera;
}

/// Means of the pixels of the largest part in the middle that has the thumbnail's proportions.
Image shrunk(const Image& image, glm::ivec2 size) {
  const double pixels = std::min(double(image.size.x) / size.x, double(image.size.y) / size.y);
  const glm::dvec2 corner = 0.5 * (glm::dvec2(image.size) - pixels * glm::dvec2(size));
  Image result{.size = size};
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      const glm::ivec2 low(corner + pixels * glm::dvec2(x, y));
      const glm::ivec2 high = glm::min(glm::max(glm::ivec2(corner + pixels * glm::dvec2(x + 1, y + 1)), low + 1), image.size);
      glm::vec4 sum(0.0f);
      for (int v = low.y; v < high.y; ++v)
        for (int u = low.x; u < high.x; ++u) sum += image.pixels[std::size_t(v) * std::size_t(image.size.x) + std::size_t(u)];
      result.pixels.push_back(sum / float(std::max((high.x - low.x) * (high.y - low.y), 1)));
    }
  return result;
}

}  // namespace

fs::path sessionFolder() {
  const char* const state = std::getenv("XDG_STATE_HOME");
  const char* const home = std::getenv("HOME");
  if (state != nullptr && fs::path(state).is_absolute()) return fs::path(state) / "freevoxels";  // as the XDG says
  return home != nullptr && *home != '\0' ? fs::path(home) / ".local/state/freevoxels" : fs::path();
}

SessionStore::SessionStore(fs::path folder) : folder_(std::move(folder)) {
  if (!folder_.empty()) take(readState(folder_ / kStateFile));
}

void SessionStore::take(const Json& root) {
  recent_.clear();
  bookmarks_.clear();
  for (const Json& name : root.value("recent", Json::array()))
    if (name.is_string() && recent_.size() < kMaxRecent) recent_.push_back(name);
  knowsHowToTurn_ = root.contains("knows_how_to_turn");
  const Json stored = root.value("bookmarks", Json::object());
  for (const auto& [volume, cameras] : stored.items()) try {
      std::vector<Camera> list;
      for (const Json& camera : cameras) list.push_back(cameraOf(camera));
      bookmarks_.emplace_back(volume, std::move(list));
    } catch (const std::exception& problem) {
      spdlog::debug("bookmarks of '{}': {}", volume, problem.what());
    }
}

void SessionStore::update(const std::function<void(Json&)>& change) {
  if (folder_.empty()) return;
  std::error_code seenWhenWriting;
  fs::create_directories(folder_, seenWhenWriting);
  const FileLock lock(folder_ / "viewer.lock");
  Json root = readState(folder_ / kStateFile);
  if (!root.value("recent", Json::array()).is_array()) root.erase("recent");
  if (!root.value("bookmarks", Json::object()).is_object()) root.erase("bookmarks");
  try {
    change(root);
    take(root);
    writeTextAtomically(folder_ / kStateFile, root.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
  } catch (const std::exception& problem) {
    spdlog::debug("{}", problem.what());
  }
}

void SessionStore::remember(const std::string& opened) {
  const std::string name = proceduralName(opened) ? opened : fs::absolute(opened).lexically_normal().string();
  update([&](Json& root) {
    Json list = Json::array({name});
    for (const Json& other : root.value("recent", Json::array()))
      if (other.is_string() && other != name && list.size() < kMaxRecent) list.push_back(other);
    root["recent"] = list;
  });
}

void SessionStore::setKnowsHowToTurn() {
  if (knowsHowToTurn_) return;
  knowsHowToTurn_ = true;
  update([](Json& root) { root["knows_how_to_turn"] = true; });
}

std::vector<Camera> SessionStore::bookmarks(const std::string& volume) const {
  const std::string name = proceduralName(volume) ? volume : fs::absolute(volume).lexically_normal().string();
  const auto found = std::ranges::find(bookmarks_, name, &std::pair<std::string, std::vector<Camera>>::first);
  return found == bookmarks_.end() ? std::vector<Camera>() : found->second;
}

void SessionStore::setBookmarks(const std::string& volume, const std::vector<Camera>& cameras) {
  const std::string name = proceduralName(volume) ? volume : fs::absolute(volume).lexically_normal().string();
  update([&](Json& root) {
    Json list = Json::array();
    for (const Camera& camera : cameras) list.push_back(cameraJson(camera));
    root["bookmarks"][name] = list;
  });
}

fs::path SessionStore::thumbnail(const std::string& file) const {
  if (folder_.empty()) return {};
  return folder_ / "thumbnails" / fmt::format("{:016x}.png", XXH3_64bits(file.data(), file.size()));
}

void SessionStore::storeThumbnail(const std::string& file, const Image& image, const DisplayLook& look) const {
  if (folder_.empty() || image.pixels.empty()) return;
  std::error_code seenWhenWriting;
  fs::create_directories(folder_ / "thumbnails", seenWhenWriting);
  try {
    writePng(thumbnail(file), shrunk(image, kThumbnailSize), look);
  } catch (const Error& error) {
    spdlog::debug("{}", withOptions(error));
  }
}

}  // namespace freevoxels
