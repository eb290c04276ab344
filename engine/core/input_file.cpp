#include "engine/core/input_file.h"

#include "engine/core/error.h"

namespace freevoxels {

void checkInputFile(std::string_view kind, const std::filesystem::path& file) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::none)
    fail(ErrorKind::Input, "cannot read {} '{}': {}; check its path and permissions", kind, file.string(), error.message());
  if (!fs::exists(status)) fail(ErrorKind::Input, "cannot read {} '{}': there is no such file; check its name", kind, file.string());
  if (!fs::is_regular_file(status))
    fail(ErrorKind::Input, "cannot read {} '{}': it is not a regular file; name one", kind, file.string());
}

}  // namespace freevoxels
