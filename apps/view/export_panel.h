#pragma once
// The panel "Export": the command line that renders the shown image, and saving of image, scene and turntable.

#include <deque>
#include <functional>
#include <memory>
#include <string>

#include "apps/view/export_job.h"
#include "apps/view/file_dialog.h"
#include "apps/view/view_state.h"

namespace freevoxels {

class ExportPanel {
 public:
  /// `finished` is called, by another thread, when something has been written.
  ExportPanel(const Device& device, FileDialog& dialog, int turnFrames, std::function<void()> finished);

  /// Into the current Dear ImGui window.
  void draw(ViewState& state);
  /// Starts what waits for the complete image, and passes on what came of it as ViewState::notice or problem. To be called in
  /// every frame.
  void follow(ViewState& state);

  /// These ask for a file name. What is asked for is written when the image is complete.
  void askImage();
  void askScene();
  void askTurntable() { askMoved(std::nullopt); }
  void askSequence(const Sequence& sequence);
  /// Copies the complete image to the clipboard, where a program for that is installed (wl-copy or xclip); otherwise its command
  /// line, and says so.
  void copyImage();
  static void copyCommand(ViewState& state);
  /// Gives up what is being written.
  void cancel();

  bool isBusy() const { return job_.busy(); }
  /// For an image to be complete, not for what is being written.
  bool waits() const { return !waiting_.empty() && !job_.busy(); }
  /// What is being written and the fraction of it that is done; nothing if there is none.
  std::optional<std::pair<std::string, double>> activity() const;

 private:
  struct Task {
    std::function<void(const DrawnImage&, const Progress&)> work;
    std::string done;
  };

  void want(Task task);
  void askMoved(const std::optional<std::string>& flight);
  void drawMoved(ViewState& state, const std::optional<std::string>& flight);
  void drawSize(glm::ivec2 window);

  const Device& device_;
  FileDialog& dialog_;
  std::string imageName_ = "image.png", sceneName_ = "scene.json", turnName_ = "turn_####.png";
  std::string sequenceName_ = "frame_####.png";
  std::optional<glm::ivec2> imageSize_;  ///< of saved images; none: that of the window
  int turnFrames_;
  std::deque<Task> waiting_;  ///< for the image to be complete
  ExportJob job_;             ///< ends before what it uses
};

}  // namespace freevoxels
