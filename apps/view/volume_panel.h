#pragma once
// The panel "Volume": the file, its grids, and the frames of a sequence.

#include <chrono>
#include <string>
#include <vector>

#include "apps/view/added_panel.h"
#include "apps/view/async_value.h"
#include "apps/view/channel_panel.h"
#include "apps/view/view_state.h"
#include "engine/volume/vdb.h"

namespace freevoxels {

class GridList {
 public:
  /// The grids of a volume by its name, or null while they are read. None for a procedural volume, and for a
  /// file that cannot be read, for which the image reports the reason.
  const std::vector<GridChoice>* of(const std::string& input) { return grids_.of(input); }

  bool isMaking() const { return grids_.isMaking(); }

 private:
  static std::vector<GridChoice> list(const std::string& input);

  AsyncValue<std::string, std::vector<GridChoice>> grids_{list};
};

/// A choice among the grids for which `suits` is true. The first word stands for the default.
bool chooseGrid(const char* label, const std::vector<GridChoice>& grids, bool GridChoice::*suits,
                const char* none, std::optional<std::string>& name);

class SequencePanel {
 public:
  /// Draws nothing unless the volume is part of a sequence. While playing, the next frame waits for its time and for the image of
  /// the previous one.
  void draw(ViewState& state);
  /// Space plays and pauses, comma and full stop step back and on. Called in every frame, whether or not the panel is open.
  void follow(ViewState& state);
  bool plays() const { return plays_; }
  void pause() { plays_ = false; }

 private:
  using Clock = std::chrono::steady_clock;

  void offer(ViewState& state);
  void playOrPause();
  void drawControls(ViewState& state, int& frame);
  void takeKeys(int frames, int& frame);
  void play(const ViewState& state, int& frame);

  enum class End { Repeat, Turn, Stop };

  bool plays_ = false, waitsForWhole_ = false;
  End end_ = End::Repeat;
  int step_ = 1;  ///< -1 while it plays backwards
  int framesPerSecond_ = 24;
  Clock::time_point shown_;
  std::string offeredFor_;  ///< the file for which a sequence was searched
  std::optional<Sequence> offered_;
  std::string problem_;  ///< of a frame that was skipped
};

class VolumePanel {
 public:
  void draw(ViewState& state, GridList& grids);
  SequencePanel& frames() { return frames_; }
  const SequencePanel& frames() const { return frames_; }

 private:
  static void drawFacts(const ViewState& state);
  static void drawGrids(ViewState& state, GridList& grids);

  SequencePanel frames_;
  AddedPanel added_;
  ChannelPanel channels_;
  std::optional<int> resolution_;  ///< while it is dragged
};

}  // namespace freevoxels
