#pragma once
// Queues input events for the window's frames, so that a press and release within one frame are both seen:
// Dear ImGui reads buttons and keys only once a frame.

#include <deque>
#include <glm/glm.hpp>
#include <vector>

namespace freevoxels {

struct InputEvent {
  enum class Kind { Move, Button, Wheel, Key, Character };
  Kind kind = Kind::Move;
  /// GLFW's number for Button and Key, the code point for Character.
  int code = 0;
  bool down = false;
  glm::dvec2 value{0.0};  ///< position of the mouse, or distance of the wheel
};

class InputQueue {
 public:
  void add(const InputEvent& event) { events_.push_back(event); }
  /// Whether the window has shown the results of all events.
  bool settled() const { return events_.empty() && unsettled_ == 0; }
  /// The next events in their order, as many as one frame can distinguish. A shortcut with Ctrl, or
  /// Enter, may move the cursor into a field, which takes some frames; text typed meanwhile waits.
  std::vector<InputEvent> nextFrame();

 private:
  std::deque<InputEvent> events_;
  bool control_ = false;          ///< whether Ctrl is held down
  int held_ = 0, unsettled_ = 0;  ///< frames
};

}  // namespace freevoxels
