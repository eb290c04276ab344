#pragma once
// Widgets for the types of the options. All return whether the value was changed in this frame; all have a
// label at the right.

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/freevoxels/failure.h"
#include "apps/view/view_state.h"

namespace freevoxels {

/// Reserves space for the labels of a panel as long as it exists.
class LabelRoom {
 public:
  LabelRoom();
  ~LabelRoom();
  LabelRoom(const LabelRoom&) = delete;
  LabelRoom& operator=(const LabelRoom&) = delete;
};

/// To the next multiple of a power of ten, without the rest that a product would have.
double roundedTo(double value, double step);

/// A tooltip of one short line for the last widget.
void hint(const char* text);

/// As Dear ImGui draws it. Of a linear colour, cut to 0..1.
std::uint32_t shownColor(glm::dvec3 linear, float alpha);

/// A colour that is shown as sRGB and stored as linear. Colours brighter than 1 keep their brightness.
bool editColor(const char* label, glm::dvec3& linear);
bool slide(const char* label, double& value, double low, double high, const char* format = "%.3g");
/// `low` must be above 0.
bool slideLogarithmic(const char* label, double& value, double low, double high, const char* format = "%.4g");
/// An optional value, which is `usual` if it is not given; it can be reset.
bool slideOptional(const char* label, std::optional<double>& value, double usual, double low, double high,
                   const char* format = "%.3g");
/// `step` is the change for each pixel of a drag.
bool dragVector(const char* label, glm::dvec3& value, double step);
bool choose(const char* label, const std::vector<std::string>& words, int& value);
/// The value is not given if it is the usual one.
bool choose(const char* label, const std::vector<std::string>& words, std::optional<int>& value, int usual);
bool tick(const char* label, std::optional<bool>& value, bool usual);
/// Returns true when the text is complete: at Enter, or when the cursor leaves it.
bool editText(const char* label, std::string& text, const char* whenEmpty);
/// A button at the right end of the line, for which the previous widget must leave space.
bool smallButtonAtRight(const char* label);

/// A slider whose middle is the value that is used if none is given: the last automatic value that is known,
/// or else the first that was seen.
class AutomaticSlider {
 public:
  /// The range in both directions.
  explicit AutomaticSlider(double factor = 100.0) : factor_(factor) {}

  bool draw(const char* label, const char* meaning, std::optional<double>& value,
            std::optional<double> automatic);

 private:
  double factor_;
  std::optional<double> middle_;
};

/// Shows the error of `action`, if it fails, in the window.
template <typename Action>
void attempt(ViewState& state, const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    state.problem = withOptions(error);
  }
}

}  // namespace freevoxels
