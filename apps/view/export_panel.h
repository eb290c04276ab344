#pragma once
// "Export": the command line that renders the shown image, and buttons that save image, scene and turntable.

#include <deque>
#include <functional>
#include <memory>
#include <string>

#include "apps/view/export_job.h"
#include "apps/view/view_state.h"

namespace freevoxels {

class ExportPanel {
 public:
  /// `finished` is called, by another thread, when something has been written.
  ExportPanel(const Device& device, int turnFrames, std::function<void()> finished);

  /// Into the current Dear ImGui window. What is wanted of a picture is written when it is complete. Ctrl+S,
  /// Ctrl+E and Ctrl+T ask for the names of a picture, a scene and a turn; Escape gives up what is being
  /// written.
  void draw(ViewState& state);
  /// For a picture to be complete, not for what is being written.
  bool waits() const { return !waiting_.empty() && !job_.busy(); }

 private:
  enum class Field { None, Picture, Scene, Turn };
  struct Task {
    std::function<void(const Picture&, const Progress&)> work;
    std::string done;
  };

  void takeKeys();
  static void drawCommand(const Picture& picture, const std::string& file);
  void drawPictureFields(ViewState& state);
  void drawTurn(const Picture* picture);
  void drawWork();
  bool wants(Field field, const char* button, std::string& name);
  void want(Task task);
  void cancel();
  void begin(const ViewState& state);

  const Device& device_;
  std::string pictureName_ = "picture.png", sceneName_ = "scene.json", turnName_ = "turn_####.png";
  int turnFrames_;
  Field focus_ = Field::None;
  std::deque<Task> waiting_;  ///< for the picture to be complete
  ExportJob::Outcome last_;
  ExportJob job_;  ///< ends before what it uses
};

}  // namespace freevoxels
