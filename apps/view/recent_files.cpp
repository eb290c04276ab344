#include "apps/view/recent_files.h"

#include <spdlog/spdlog.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "apps/freevoxels/failure.h"
#include "engine/core/atomic_file.h"
#include "engine/core/json_file.h"

namespace freevoxels {

namespace {

namespace fs = std::filesystem;

}  // namespace

fs::path recentFilesPath() {
  const char* const state = std::getenv("XDG_STATE_HOME");
  const char* const home = std::getenv("HOME");
  const fs::path own = fs::path("freevoxels") / "recent.json";
  if (state != nullptr && fs::path(state).is_absolute()) return state / own;  // as the XDG says
  return home != nullptr && *home != '\0' ? fs::path(home) / ".local/state" / own : fs::path();
}

RecentFiles::RecentFiles(fs::path file) : file_(std::move(file)) {
  std::error_code unknown;
  if (file_.empty() || !fs::exists(file_, unknown)) return;
  try {
    for (const auto& name : readJson("list of recent files", file_))
      if (name.is_string() && list_.size() < kMost) list_.push_back(name);
  } catch (const Error& error) {
    spdlog::debug("{}", withOptions(error));
  }
}

void RecentFiles::add(const std::string& opened) {
  if (file_.empty()) return;
  const std::string name = fs::absolute(opened).lexically_normal().string();
  std::erase(list_, name);
  list_.insert(list_.begin(), name);
  if (list_.size() > kMost) list_.resize(kMost);
  try {
    std::error_code seenWhenWriting;
    fs::create_directories(file_.parent_path(), seenWhenWriting);
    using Json = nlohmann::json;
    writeTextAtomically(file_, Json(list_).dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
  } catch (const Error& error) {
    spdlog::debug("{}", withOptions(error));
  }
}

}  // namespace freevoxels
