#pragma once
// Widgets of the options' own types. All return whether the value was changed in this frame; all have a
// label at the right.

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/view/view_state.h"
#include "engine/core/error.h"

namespace freevoxels {

/// Leaves room for the labels of a panel, as long as it lives.
class LabelRoom {
 public:
  LabelRoom();
  ~LabelRoom();
  LabelRoom(const LabelRoom&) = delete;
  LabelRoom& operator=(const LabelRoom&) = delete;
};

/// To the next multiple of a power of ten, without the rest that a product would have.
double roundedTo(double value, double step);

/// What the last widget is for, while the mouse is on it. One short line.
void hint(const char* text);

/// As Dear ImGui draws it. Of a linear colour, cut to 0..1.
std::uint32_t shownColor(glm::dvec3 linear, float alpha);

/// Shown as sRGB, kept linear. Of colours brighter than 1 the brightness stays.
bool editColor(const char* label, glm::dvec3& linear);
bool slide(const char* label, double& value, double low, double high, const char* format = "%.3g");
/// `low` is above 0.
bool slideLogarithmic(const char* label, double& value, double low, double high, const char* format = "%.4g");
/// The value is `usual` where it is not given, and can be given back.
bool slideOptional(const char* label, std::optional<double>& value, double usual, double low, double high,
                   const char* format = "%.3g");
/// `step` is what a pixel of a drag adds.
bool dragVector(const char* label, glm::dvec3& value, double step);
bool choose(const char* label, const std::vector<std::string>& words, int& value);
/// Not given where it is the usual one.
bool choose(const char* label, const std::vector<std::string>& words, std::optional<int>& value, int usual);
bool tick(const char* label, std::optional<bool>& value, bool usual);
/// When the text is complete: at Enter, or where the cursor leaves it.
bool editText(const char* label, std::string& text, const char* whenEmpty);
/// A button at the right end of the line, of which the widget before has to leave room.
bool smallButtonAtRight(const char* label);

/// A slider whose middle is what the value is where it is not given: the last automatic value that was known,
/// or else the first that was seen.
class AutomaticSlider {
 public:
  /// How far it goes either way.
  explicit AutomaticSlider(double factor = 100.0) : factor_(factor) {}

  bool draw(const char* label, const char* meaning, std::optional<double>& value,
            std::optional<double> automatic);

 private:
  double factor_;
  std::optional<double> middle_;
};

/// What the user has to read of `action`, in the window.
template <typename Action>
void attempt(ViewState& state, const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    state.problem = error.what();
  }
}

}  // namespace freevoxels
