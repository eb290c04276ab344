#include "apps/freevoxels/frame_names.h"

#include <algorithm>

#include "engine/core/error.h"

namespace freevoxels {

std::string frameName(const std::string& pattern, int frame) {
  const std::size_t slash = pattern.rfind('/');
  const std::size_t name = slash == std::string::npos ? 0 : slash + 1;
  const std::size_t first = pattern.find('#', name);
  if (first == std::string::npos)
    fail(ExitCode::Usage,
         "'{}' has no place for the number of the frame: put a run of # into the file name, as in "
         "orbit_####.png",
         pattern);
  const std::size_t end = std::min(pattern.find_first_not_of('#', first), pattern.size());
  if (pattern.find('#', end) != std::string::npos)
    fail(ExitCode::Usage, "'{}' has several runs of #: leave one, for the number of the frame", pattern);
  return fmt::format("{}{:0{}}{}", pattern.substr(0, first), frame, end - first, pattern.substr(end));
}

std::vector<std::vector<std::string>> frameNames(const std::vector<std::string>& patterns, int frames) {
  std::vector<std::vector<std::string>> names(static_cast<std::size_t>(frames));
  for (int frame = 0; frame < frames; ++frame)
    for (const std::string& pattern : patterns)
      names[std::size_t(frame)].push_back(frameName(pattern, frame));
  return names;
}

}  // namespace freevoxels
