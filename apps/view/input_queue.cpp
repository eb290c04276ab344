#include "apps/view/input_queue.h"

#include <GLFW/glfw3.h>

#include <algorithm>

namespace freevoxels {

namespace {

using Kind = InputEvent::Kind;

constexpr int kShortcutFrames = 5;  // until a field that is asked for has the cursor
constexpr int kSettlingFrames = 3;  // in which Dear ImGui shows what came of an event

bool isControl(const InputEvent& event) {
  return event.kind == Kind::Key &&
         (event.code == GLFW_KEY_LEFT_CONTROL || event.code == GLFW_KEY_RIGHT_CONTROL);
}

bool isRelease(const InputEvent& event) { return event.kind == Kind::Key && !event.down; }

bool isModifier(const InputEvent& event) {
  return event.kind == Kind::Key && event.code >= GLFW_KEY_LEFT_SHIFT && event.code <= GLFW_KEY_RIGHT_SUPER;
}

/// Whether a frame that has `before` would see something else than happened if it had `event` as well.
bool hides(const InputEvent& event, const InputEvent& before) {
  if (isModifier(event) || isModifier(before))
    return isModifier(event) && (!isModifier(before) || before.code == event.code);
  switch (event.kind) {
    case Kind::Move:
      return before.kind == Kind::Button || before.kind == Kind::Wheel;
    case Kind::Button:
      return before.kind != Kind::Move || !event.down;  // a drag is on before it ends
    case Kind::Wheel:
      return before.kind == Kind::Button;
    case Kind::Key:
      if (before.kind == Kind::Key) return before.code == event.code || (event.down && before.down);
      return event.down && before.kind != Kind::Move;
    case Kind::Character:
      return before.kind == Kind::Button;
  }
  return false;
}

}  // namespace

void InputQueue::take(std::vector<InputEvent>& frame) {
  const InputEvent& next = events_.front();
  if (isControl(next)) control_ = next.down;
  frame.push_back(next);
  events_.pop_front();
}

std::vector<InputEvent> InputQueue::nextFrame() {
  std::vector<InputEvent> frame;
  if (held_ > 0) {
    --held_;
    // Keys that are released do not wait: while one is down Dear ImGui repeats it, and Enter would leave the field.
    while (!events_.empty() && isRelease(events_.front())) take(frame);
    if (!frame.empty()) unsettled_ = kSettlingFrames;
    return frame;
  }
  while (!events_.empty()) {
    const InputEvent& next = events_.front();
    if (std::ranges::any_of(frame, [&](const InputEvent& before) { return hides(next, before); })) break;
    const bool confirms = next.kind == Kind::Key && next.code == GLFW_KEY_ENTER;
    if (next.kind == Kind::Key && next.down && (confirms || (control_ && !isModifier(next)))) held_ = kShortcutFrames;
    take(frame);
  }
  unsettled_ = frame.empty() ? std::max(unsettled_ - 1, 0) : kSettlingFrames;
  return frame;
}

}  // namespace freevoxels
