#pragma once
// The file names of a sequence: "orbit_####.png" and "orbit_%04d.png" are orbit_0000.png, orbit_0001.png, ...

#include <compare>
#include <optional>
#include <string>
#include <string_view>

namespace freevoxels {

/// Whole; below 0 for frames before a simulation's start; with a fraction for steps between frames.
struct FrameNumber {
  double value = 0.0;
  std::string fraction;  ///< with the point, as the file name has it: ".5" of 1.5

  FrameNumber() = default;
  FrameNumber(int number) : value(number) {}
  FrameNumber(double number, std::string fractionInName) : value(number), fraction(std::move(fractionInName)) {}

  /// The digits before the fraction are padded with zeros to this number: "-0001.5".
  std::string text(std::size_t digits) const;
  auto operator<=>(const FrameNumber&) const = default;
};

/// A pattern with a run of #, divided at the path component that has it: the file name, or the last such folder if the file name has none.
struct NumberPlace {
  std::string folder;         ///< in front of the component: "film/" of "film/s##/smoke.vdb"; may be empty
  std::string before, after;  ///< of the component, around the run: "s" and ""
  std::string rest;           ///< behind the component: "/smoke.vdb"; may be empty
  std::size_t digits = 0;     ///< length of the run
};

/// Fails with ErrorKind::Usage if the pattern has no such place, or several in one name.
NumberPlace placeOfNumber(const std::string& pattern);

/// Whether a text has a run of # or %d or %0Nd.
bool hasNumberPlace(const std::string& text);

/// The pattern with the frame's number, padded with zeros, in its place; numbers with more digits are not cut. Standard output is one for
/// all frames. Fails as placeOfNumber does.
std::string frameName(const std::string& pattern, const FrameNumber& frame);

/// The number in a name of the pattern, which has a minus before the padded digits, or as the first of them; nothing for other names.
std::optional<FrameNumber> frameOf(std::string_view name, const NumberPlace& pattern);

/// The pattern with a run of # in place of %d or %0Nd; any other text as it is.
std::string withHashes(const std::string& pattern);

}  // namespace freevoxels
