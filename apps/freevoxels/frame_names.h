#pragma once
// The file names of a sequence: "orbit_####.png" and "orbit_%04d.png" are orbit_0000.png, orbit_0001.png, ...

#include <string>
#include <vector>

namespace freevoxels {

/// The pattern with a run of # in place of %d or %0Nd in its file name; any other text as it is.
std::string withHashes(const std::string& pattern);

/// The pattern with the frame's number, padded with zeros, in place of the run of # (or %0Nd) in its file
/// name; numbers with more digits are not cut. Standard output is one for all frames. Fails with ErrorKind::Usage if the file name has no
/// such place, or several.
std::string frameName(const std::string& pattern, int frame);

}  // namespace freevoxels
