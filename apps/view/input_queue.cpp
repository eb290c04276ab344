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

std::vector<InputEvent> InputQueue::nextFrame() {
  std::vector<InputEvent> frame;
  const bool waits = held_ > 0;
  if (waits) --held_;
  while (!events_.empty()) {
    const InputEvent& next = events_.front();
    if (std::ranges::any_of(frame, [&](const InputEvent& before) { return hides(next, before); })) break;
    // Keys that are released do not wait: while one is down Dear ImGui repeats it, and Enter would leave the field.
    // What follows does, anew.
    if (waits && !isRelease(next)) break;
    const bool confirms = next.kind == Kind::Key && next.code == GLFW_KEY_ENTER;
    if (waits || (next.kind == Kind::Key && next.down && (confirms || (control_ && !isModifier(next)))))
      held_ = kShortcutFrames;
    if (isControl(next)) control_ = next.down;
    frame.push_back(next);
    events_.pop_front();
  }
  if (!frame.empty())
    unsettled_ = kSettlingFrames;
  else if (!waits)
    unsettled_ = std::max(unsettled_ - 1, 0);
  return frame;
}

}  // namespace freevoxels
