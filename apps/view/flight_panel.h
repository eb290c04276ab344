#pragma once
// The part of the panel "View" that makes and plays flights: a camera, and lights, that move through key frames.

#include <string>

#include "apps/view/file_dialog.h"
#include "apps/view/view_state.h"

namespace freevoxels {

class FlightPanel {
 public:
  explicit FlightPanel(FileDialog& dialog) : dialog_(dialog) {}

  /// Draws the rows. `state` has a camera.
  void draw(ViewState& state);
  /// Moves on while it plays. Called in every frame, whether or not the panel is open; `seconds` since the last one.
  void follow(ViewState& state, double seconds);
  bool plays() const { return plays_; }
  void pause() { plays_ = false; }

 private:
  FlightKeyDescription keyOf(const ViewState& state) const;
  void drawKeys(ViewState& state);
  void drawPlayer(ViewState& state);

  FileDialog& dialog_;
  std::string name_ = "flight.json", outcome_;  ///< outcome_: of the last saving
  bool plays_ = false, keepsLights_ = false;    ///< keepsLights_: whether keys that are added have the lights
  double time_ = 0.0;                           ///< in the flight that is shown
};

/// The flight as the value of --flight; nothing where there are too few keys.
std::optional<std::string> flightOf(const Edits& edits);

}  // namespace freevoxels
