#pragma once
// What hands do, given to the frames of the window so that none of it is lost: Dear ImGui looks at buttons
// and keys once a frame, and a key can be down and up again before the next.

#include <deque>
#include <glm/glm.hpp>
#include <vector>

namespace freevoxels {

struct InputEvent {
  enum class Kind { Move, Button, Wheel, Key, Character };
  Kind kind = Kind::Move;
  /// Of Button and Key GLFW's number, of Character the code point.
  int code = 0;
  bool down = false;
  glm::dvec2 value{0.0};  ///< where the mouse is, or how far the wheel was turned
};

class InputQueue {
 public:
  void add(const InputEvent& event) { events_.push_back(event); }
  /// Whether the window has shown all that came of it.
  bool settled() const { return events_.empty() && unsettled_ == 0; }
  /// In their order, as many as one frame tells apart. A shortcut with Ctrl may move the cursor into a field,
  /// which takes some frames; what is typed meanwhile waits.
  std::vector<InputEvent> nextFrame();

 private:
  std::deque<InputEvent> events_;
  bool control_ = false;          ///< is held down
  int held_ = 0, unsettled_ = 0;  ///< frames
};

}  // namespace freevoxels
