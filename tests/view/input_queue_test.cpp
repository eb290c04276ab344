#include "apps/view/input_queue.h"

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include <string>

namespace freevoxels {
namespace {

using Kind = InputEvent::Kind;

InputEvent move(double x) {
  return {.kind = Kind::Move, .value = {x, 0.0}};
}
InputEvent button(bool down) {
  return {.kind = Kind::Button, .code = GLFW_MOUSE_BUTTON_LEFT, .down = down};
}
InputEvent key(int code, bool down) {
  return {.kind = Kind::Key, .code = code, .down = down};
}
InputEvent character(char c) {
  return {.kind = Kind::Character, .code = c};
}

/// How many events each frame has: "212".
std::string frames(std::initializer_list<InputEvent> events) {
  InputQueue queue;
  for (const InputEvent& event : events) queue.add(event);
  std::string counts;
  while (!queue.settled()) counts += std::to_string(queue.nextFrame().size());
  EXPECT_TRUE(counts.ends_with("000")) << counts << ": what comes of it is seen";
  return counts.substr(0, counts.size() - 3);
}

TEST(InputQueue, AKeyThatIsUpAtOnceIsSeen) {
  EXPECT_EQ(frames({key('F', true), key('F', false)}), "11");
  EXPECT_EQ(frames({key('F', true), key('F', false), key('F', true), key('F', false)}), "1111");
}

TEST(InputQueue, AClickIsSeenAndWhereItWas) {
  EXPECT_EQ(frames({move(1), button(true), button(false)}), "21");
  EXPECT_EQ(frames({move(1), move(2), button(true), move(3), move(4), button(false), move(5)}), "3211");
}

TEST(InputQueue, ModifiersHoldForWhatIsBetweenThem) {
  EXPECT_EQ(frames({key(GLFW_KEY_LEFT_CONTROL, true), key('S', true), key('S', false),
                    key(GLFW_KEY_LEFT_CONTROL, false)}),
            "21100000")
      << "and what is typed then waits for the field";
  EXPECT_EQ(frames({key(GLFW_KEY_LEFT_SHIFT, true),
                    {.kind = Kind::Wheel, .value = {0.0, 1.0}},
                    key(GLFW_KEY_LEFT_SHIFT, false)}),
            "21");
}

TEST(InputQueue, TextComesBeforeTheKeyAfterIt) {
  EXPECT_EQ(frames({key('A', true), character('a'), key('A', false), key('B', true), character('b'),
                    key('B', false), key(GLFW_KEY_ENTER, true)}),
            "23200000");
  EXPECT_EQ(frames({character('a'), character('b'), key(GLFW_KEY_ENTER, true)}), "2100000")
      << "what is typed after Enter waits for the field that it leads to";
}

TEST(InputQueue, ReleasedKeysDoNotWaitForTheFieldInWhichTheyWouldRepeat) {
  EXPECT_EQ(frames({key(GLFW_KEY_ENTER, true), key(GLFW_KEY_ENTER, false), character('a')}), "11000001");
}

TEST(InputQueue, TheOrderStays) {
  InputQueue queue;
  for (const InputEvent& event : {move(1), move(2), move(3)}) queue.add(event);
  const std::vector<InputEvent> frame = queue.nextFrame();
  ASSERT_EQ(frame.size(), 3u);
  EXPECT_EQ(frame.back().value.x, 3.0);
}

}  // namespace
}  // namespace freevoxels
