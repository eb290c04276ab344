#pragma once
// Names of files, as a person types them.

#include <string>

namespace freevoxels {

/// A field for a name with a button beside it. True when it is wanted: by the button, or by Enter in the
/// field. `focus` puts the cursor there.
bool fileField(const char* button, std::string& text, bool focus);

/// The file that is meant: "~/" is the home folder, blanks around are no part of it.
std::string meantFile(const std::string& text);

/// A sentence that went wrong, or right.
void drawSentence(const std::string& sentence, bool good);

}  // namespace freevoxels
