#pragma once
// What the headers of an OpenEXR file claim, before OpenEXR allocates memory for it.

#include <filesystem>

namespace freevoxels {

/// Fails with ErrorKind::Input if an attribute in a header is longer than the rest of the file, or if the image, a large tile or a table of
/// chunks is larger than a file of that size can hold in its compression: OpenEXR allocates memory for all of it before it reads. Of several
/// parts the first one's image counts, which is what is read. Whatever else is wrong with the file is left to OpenEXR.
void checkExrClaims(const std::filesystem::path& file);

}  // namespace freevoxels
