#pragma once
// A small image by freevoxels render.

#include <string>

#include "tests/commands/program_runner.h"

namespace freevoxels::test {

inline constexpr const char* kSmall = " --resolution 24 --size 64x48 ";

class RenderCommand : public CommandTest {
 protected:
  std::string render(const std::string& options, const std::string& file = "a.exr") const {
    SCOPED_TRACE(options);
    expectSuccess(run("render procedural:cloud @" + file + kSmall + options));
    return readBytes(folder / file);
  }
};

}  // namespace freevoxels::test
