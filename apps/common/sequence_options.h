#pragma once
// Several volumes for one command: the files of a pattern, or named one by one.

#include <optional>
#include <string>
#include <vector>

#include "apps/common/render_options.h"

namespace freevoxels {

struct SequenceOptions {
  std::optional<std::string> frames;   ///< what readFrameRange reads
  std::optional<std::string> folder;   ///< of the images
  std::optional<std::string> formats;  ///< extensions with commas between them, of images that have the names of their volumes

  /// --frames, --out-dir, --format and, into `fixedView`, --fixed-view.
  void add(CLI::App& app, std::optional<bool>& fixedView);
  /// The frames of the words IN and OUT, before `scene.takeScene()`: volumes among OUT are inputs, too. Without OUT an image has
  /// the name of its volume. Takes the scene; makes the folder; warns of gaps. ErrorKind::Usage for options that say nothing.
  std::vector<FrameJob> plan(SceneOptions& scene) const;
};

}  // namespace freevoxels
