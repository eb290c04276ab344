#pragma once
// Options and work that `render` and `turntable` share: images of one volume, whose table is made once, or of
// several volumes.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/common/device_options.h"
#include "apps/common/program.h"
#include "apps/common/scene_options.h"
#include "apps/common/share_group.h"
#include "apps/common/share_options.h"
#include "apps/common/timings_file.h"

namespace freevoxels {

/// A volume, and the images of it to write: one view in several forms.
struct FrameJob {
  std::string input;
  std::vector<std::string> files;
  std::optional<std::string> holdout = {};  ///< in place of that of the scene, which may be a pattern
  bool isSkipped = false;  ///< whether it is not drawn, but counts as a frame of its turn or film
};

struct RenderOptions {
  SceneOptions scene;
  DeviceOptions device;
  MessageOptions messages;
  std::optional<std::string> timings;
  /// Whether all frames are seen as the first one is where options leave that open; else as the film is (film_view.h).
  std::optional<bool> fixedView;
  bool skipsExisting = false;  ///< whether frames whose images exist are left as they are
  ShareOptions shares;
  /// The processes among which every frame is divided; null: this process draws alone, what `shares` says. Lives longer.
  ShareGroup* group = nullptr;

  void add(CLI::App& app);
  /// Adds --skip-existing, which `run` obeys, where there is no group.
  void addSkipExisting(CLI::App& app);
  /// Draws the frames; those of one volume are the steps of a full turn. Refuses whatever can be refused before any work.
  void run(std::vector<FrameJob> frames) const;
  /// Without lighting.
  FrameSettings frameSettings() const;
  /// Whether this process prints and writes: alone, or the first of its group.
  bool leads() const { return group == nullptr || group->leads(); }
  /// Whether frames are drawn as sums of shares.
  bool drawsShares() const { return group != nullptr || shares.isGiven(); }

 private:
  void check(std::span<const FrameJob> frames) const;
  void skipExisting(std::span<FrameJob> frames) const;
  void checkShares(std::span<const FrameJob> frames) const;
};

}  // namespace freevoxels
