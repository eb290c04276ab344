#pragma once
// Runs freevoxels-view on a display that nobody sees, with hands on its keys and mouse.

#include <memory>
#include <optional>
#include <string>

#include "engine/image/image.h"
#include "tests/commands/program_runner.h"

namespace freevoxels::test {

/// Path of a program that may be installed.
std::optional<std::string> installedProgram(const std::string& name);

/// An X server of its own, which DISPLAY names as long as this lives.
class Display {
 public:
  Display();
  ~Display();
  Display(const Display&) = delete;
  Display& operator=(const Display&) = delete;

  /// What the screen shows, as linear colours.
  Image screen() const;

 private:
  const std::filesystem::path memory_;  ///< folder of the file in which the server keeps the screen's pixels
  pid_t server_ = -1;
};

/// The program in the folder that it is given, and in no other.
class ViewerSession {
 public:
  ViewerSession(const std::filesystem::path& folder, const Arguments& arguments);
  /// Ends it where quit() has not.
  ~ViewerSession();
  ViewerSession(const ViewerSession&) = delete;
  ViewerSession& operator=(const ViewerSession&) = delete;

  /// xdotool's words, "@" for the window: "mousemove 800 400 click 4", "windowsize @ 500 400".
  void hands(const std::string& words) const;
  /// Presses the shortcut, types the name and Enter; waits until there is such a file, and returns it.
  std::string save(char shortcut, const std::string& name) const;
  /// The same of a pattern, whose last file is `last`.
  void saveAll(char shortcut, const std::string& pattern, const std::string& last) const;
  void open(const std::string& name) const;
  /// Ctrl+Q, and how it ended.
  ProgramResult quit();

 private:
  void type(char shortcut, const std::string& text) const;

  const std::filesystem::path folder_;
  pid_t child_ = -1;
  std::string window_;
};

}  // namespace freevoxels::test
