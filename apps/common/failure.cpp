#include "apps/common/failure.h"

#include <algorithm>
#include <cerrno>
#include <new>
#include <string_view>
#include <system_error>

#include "engine/description/scene_fields.h"

namespace freevoxels {

ExitCode exitCodeOf(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::Usage:
      return ExitCode::Usage;
    case ErrorKind::Input:
      return ExitCode::Input;
    case ErrorKind::Output:
      return ExitCode::Output;
    case ErrorKind::Device:
      return ExitCode::Device;
    case ErrorKind::OutOfMemory:
      return ExitCode::OutOfMemory;
    case ErrorKind::Comparison:
      return ExitCode::Comparison;
    case ErrorKind::Internal:
      break;
  }
  return ExitCode::Internal;
}

std::string withOptions(std::string_view text) {
  return spelled(text, [](std::string_view name, std::string_view value) {
    if (value.empty()) return fmt::format("--{}", name);
    const auto field = std::ranges::find(sceneFields(), name, &SceneField::name);
    const bool isSwitchedOff = value == kNone && field != sceneFields().end() && field->standsAlone;
    return isSwitchedOff ? fmt::format("--no-{}", name) : fmt::format("--{} {}", name, value);
  });
}

Failure currentFailure() {
  try {
    throw;
  } catch (const Error& error) {
    return {exitCodeOf(error.kind()), withOptions(error)};
  } catch (const std::bad_alloc&) {
    return {ExitCode::OutOfMemory,
            "this machine's memory, or the share that this process may use (ulimit -v), is full: use a smaller volume or image"};
  } catch (const std::exception& error) {
    // std::thread and oneTBB have different exceptions for it.
    if (std::string_view(error.what()).find(std::generic_category().message(EAGAIN)) != std::string_view::npos)
      return {ExitCode::OutOfMemory,
              "no more threads can be started: raise the limits on threads and memory (ulimit -u, ulimit -v), or end other programs"};
    return {ExitCode::Internal, fmt::format("internal error, please report it: {}", error.what())};
  } catch (...) {
    return {ExitCode::Internal, "internal error, please report it: an exception of unknown type"};
  }
}

}  // namespace freevoxels
