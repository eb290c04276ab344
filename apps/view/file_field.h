#pragma once
// Input fields for file names.

#include <string>

namespace freevoxels {

/// A field for a name with a button beside it. Returns true if it is confirmed, by the button or by Enter.
/// `focus` puts the cursor into the field.
bool fileField(const char* button, std::string& text, bool focus);

/// The file of a typed name: "~/" is the home folder, surrounding blanks are removed.
std::string meantFile(const std::string& text);

/// Shows a sentence about an error or a success.
void drawSentence(const std::string& sentence, bool good);

}  // namespace freevoxels
