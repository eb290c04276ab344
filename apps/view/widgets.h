#pragma once
// Widgets for the types of the options: a label at the left and the value at the right. All return whether the user changed the
// value in this frame.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/common/failure.h"
#include "apps/view/transfer_model.h"
#include "apps/view/view_state.h"
#include "engine/description/scene_fields.h"

namespace freevoxels {

/// Begins a line with a label at its left; the next widget fills the rest. Returns that widget's name for Dear ImGui, which is
/// valid until the next call.
const char* beginRow(const char* label);
/// The header of a panel, which is closed and disabled until there is an image. Returns whether it is open.
bool panelHeader(const char* name, bool hasImage, bool isOpenAtFirst);
/// A heading within a panel.
void heading(const char* text);
/// A tooltip for the last widget and its label; `option` is the command line's name of it.
void hint(const char* text, const char* option = nullptr);

/// A linear colour as Dear ImGui draws it, clamped to 0..1.
std::uint32_t shownColor(glm::dvec3 linear, float alpha);

/// A colour that is shown as sRGB and stored as linear. Colours brighter than 1 keep their brightness.
bool editColor(const char* label, glm::dvec3& linear);
/// The same as a square alone, without a line of its own.
bool editSwatch(const char* name, glm::dvec3& linear);
bool slide(const char* label, double& value, double low, double high, const char* format = "%.3g");
/// `low` must be above 0.
bool slideLogarithmic(const char* label, double& value, double low, double high, const char* format = "%.4g");
/// A whole number, with what it means beside the slider.
bool slideWhole(const char* label, int& value, int low, int high, const std::string& shown, bool isLogarithmic = false);
/// An optional value, which is `usual` if it is not given; it can be reset.
bool slideOptional(const char* label, std::optional<double>& value, double usual, double low, double high,
                   const char* format = "%.3g");
/// `step` is the change for each pixel of a drag.
bool dragVector(const char* label, glm::dvec3& value, double step);
bool choose(const char* label, const std::vector<std::string>& words, int& value);
/// Draws the entries of an open combo box by `draw`, which is given their numbers and whose last widget is the entry, of which `chosen` is
/// current at first. Letters that are typed go to the next entry that begins with them (TypedText), as arrows do, and Enter chooses it.
void drawEntries(const std::vector<std::string>& entries, std::size_t chosen, const std::function<void(std::size_t)>& draw);
/// The value is not given if it is the usual one.
template <typename Enum>
bool choose(const char* label, const Words<Enum>& words, std::optional<Enum>& value, Enum usual) {
  int chosen = int(value.value_or(usual)) - words.first;
  if (!choose(label, words.texts, chosen)) return false;
  value = words.at(chosen);
  if (value == usual) value.reset();
  return true;
}
/// A check box with an outline, so that an empty one is seen as such.
bool checkBox(const char* label, bool* value);
bool tick(const char* label, bool& value);
bool tick(const char* label, std::optional<bool>& value, bool usual);
/// Returns true when the text is complete: at Enter, or when the cursor leaves it.
bool editText(const char* label, std::string& text, const char* whenEmpty);

/// Shows a sentence about an error or a success.
void drawSentence(const std::string& sentence, bool good);

/// The file of a typed name: "~/" is the home folder, surrounding blanks are removed.
std::string meantFile(const std::string& text);

/// A slider whose middle is the value that is used if none is given: the last automatic value that is known,
/// or else the first that was seen.
class AutomaticSlider {
 public:
  /// The range in both directions.
  explicit AutomaticSlider(double factor = 100.0) : factor_(factor) {}

  bool draw(const char* label, const char* meaning, const char* option, std::optional<double>& value,
            std::optional<double> automatic, const char* format = "%.4g");

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
