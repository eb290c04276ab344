#pragma once
// The panel "Frames": plays a sequence.

#include <chrono>
#include <string>

#include "apps/view/view_state.h"

namespace freevoxels {

class SequencePanel {
 public:
  /// Draws into the current Dear ImGui window, unless the volume is not part of a sequence. While playing,
  /// the next frame waits for its time and for the image of the previous one. Space plays and pauses, comma
  /// and full stop step back and on.
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
  std::string offeredFor_;  ///< the file for which a sequence was searched
  std::optional<Sequence> offered_;
  std::string problem_;  ///< of a frame that was skipped
};

}  // namespace freevoxels
