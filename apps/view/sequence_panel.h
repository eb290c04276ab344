#pragma once
// "Frames": goes through a sequence.

#include <chrono>
#include <string>

#include "apps/view/view_state.h"

namespace freevoxels {

class SequencePanel {
 public:
  /// Into the current Dear ImGui window; nothing where the volume is no frame of others. While it plays, the
  /// next frame waits for its time and for the picture of the one before. Space plays and pauses,
  /// comma and full stop go back and on.
  void draw(ViewState& state);
  bool plays() const { return plays_; }
  void pause() { plays_ = false; }

 private:
  using Clock = std::chrono::steady_clock;

  void offer(ViewState& state);
  void playOrPause();
  void drawControls(ViewState& state, int& frame);
  void takeKeys(int frames, int& frame);
  void play(const ViewState& state, int& frame);

  bool plays_ = false;
  float framesPerSecond_ = 24.0f;
  Clock::time_point shown_;
  std::string offeredFor_;  ///< the file that was looked for frames around
  std::optional<Sequence> offered_;
  std::string problem_;  ///< of a frame that was passed over
};

}  // namespace freevoxels
