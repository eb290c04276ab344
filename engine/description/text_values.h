#pragma once
// Values as text: numbers and lists of numbers in one word, "1,2,3"; colours; words. Reading fails with ErrorKind::Usage and one
// sentence that names what is read. NaN and infinities are always refused.

#include <glm/glm.hpp>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/volume/slice.h"
#include "engine/volume/transfer_curves.h"

namespace freevoxels {

/// A range that includes both ends.
struct NumberRange {
  double minimum = -std::numeric_limits<double>::infinity();
  double maximum = std::numeric_limits<double>::infinity();
};

/// The form of a text of numbers.
struct NumberForm {
  std::string name;       ///< what sentences call the text
  std::string form;       ///< how the text is shown: "DEG", "X,Y,Z"; one that begins with "R,G,B" also takes namedColor's texts
  std::size_t count = 1;  ///< 0: one number that may be left out
  NumberRange range = {};
  bool whole = false;
  bool mayBeOne = false;  ///< whether one number stands for `count` equal ones
  char separator = ',';
};

/// Reads `form.count` numbers.
std::vector<double> readNumbers(const NumberForm& form, const std::string& text);

/// The linear Rec.709 colour of "#rrggbb" in sRGB or of a basic CSS name such as "white".
std::optional<glm::dvec3> namedColor(const std::string& text);

/// "a=1,2,b=3" as {a: "1,2", b: "3"}; `name` and `form` as in NumberForm.
std::map<std::string, std::string> readKeys(const std::string& name, const std::string& form, const std::string& text);

/// The index of the word that the text is.
int readWord(const std::string& name, const std::vector<std::string>& words, const std::string& text);

/// Whether a text that names a JSON file is JSON itself.
bool isInlineJson(const std::string& text);

inline constexpr const char* kWindowForm = "CENTER,WIDTH|LO..HI";
/// A window of values, by its middle and width, or by its ends.
ValueWindow readWindow(const std::string& name, const std::string& text);
/// The text of a window, as LO..HI.
std::string windowText(const ValueWindow& window);

inline constexpr const char* kSliceForm = "AXIS:POSITION[%]";
/// A plane across an axis of the world: "z:12.5", "y:50%".
SlicePlane readSlicePlane(const std::string& name, const std::string& text);
std::string slicePlaneText(const SlicePlane& plane);

/// The shortest text that is read as the same number.
std::string numberText(double value);
std::string numberText(glm::dvec3 value);

}  // namespace freevoxels
