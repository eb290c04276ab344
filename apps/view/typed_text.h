#pragma once
// Names that are found by typing how they begin.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace freevoxels {

/// Whether a text has a part, whatever the case of its letters.
bool containsIgnoringCase(const std::string& text, const std::string& part);
/// Whether it begins with the part.
bool startsIgnoringCase(const std::string& text, const std::string& part);

/// Letters that are typed while a list is open.
class TypedText {
 public:
  /// Adds letters that were typed at a time in seconds; after more than a second without any they begin a new text. Returns the first entry
  /// from `current` on, and then from the beginning of the list, that begins with the text, whatever the case of its letters. One letter,
  /// once or several times, goes to the next entry after `current` that begins with it. Nothing if no entry begins so, or nothing was
  /// typed.
  std::optional<std::size_t> find(const std::vector<std::string>& entries, std::size_t current, const std::string& letters, double time);

 private:
  std::string text_;
  double last_ = 0.0;  ///< time of the last letter
};

}  // namespace freevoxels
