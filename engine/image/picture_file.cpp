#include <array>
#include <fstream>
#include <string_view>

#include "engine/core/error.h"
#include "engine/image/image.h"

namespace freevoxels {

Image readPicture(const std::filesystem::path& file) {
  constexpr std::string_view kPng = "\x89PNG", kExr = "\x76\x2f\x31\x01";
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error))
    fail(ExitCode::Input, "cannot read '{}': there is no such file; check its name", file.string());
  std::array<char, 4> start{};
  std::ifstream stream(file, std::ios::binary);
  stream.read(start.data(), start.size());
  if (!stream.is_open() || stream.bad())
    fail(ExitCode::Input, "cannot read '{}': it cannot be opened; check its permissions", file.string());
  const std::string_view signature(start.data(), start.size());
  if (signature == kExr) return readExr(file);
  if (signature == kPng) return readPng(file);
  fail(ExitCode::Input, "cannot read '{}': it is neither an OpenEXR nor a PNG image; choose one that is",
       file.string());
}

}  // namespace freevoxels
