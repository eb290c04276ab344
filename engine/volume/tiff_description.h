#pragma once
// Internal to the reader of TIFF: what the description of the first page says of all pages, as ImageJ and OME write it.

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/volume/scan_file.h"

namespace freevoxels {

struct TiffDescription {
  std::string format;                        ///< "TIFF of ImageJ", "OME-TIFF"
  int channels = 1, slices = 1, frames = 1;  ///< 1 to 2^20 each
  std::string order = "CZT";                 ///< of the pages, the fastest first
  std::vector<int> pages;                    ///< of OME, the page of each plane in that order; -1: there is none. Empty: as they follow
  std::optional<double> unit;                ///< millimetres of the unit of the resolution
  std::array<std::optional<double>, 3> distance;  ///< between voxels, in millimetres, or in a unit that is none of lengths
  std::vector<ScanChannel> described;             ///< as many as channels, or none

  std::uint64_t planes() const { return std::uint64_t(channels) * std::uint64_t(slices) * std::uint64_t(frames); }
  /// The place of a plane among all.
  std::uint64_t planeAt(int channel, int slice, int frame) const;
};

/// Nothing where the text is no such description. Fails with ErrorKind::Input where it is one and is damaged.
std::optional<TiffDescription> imageJDescription(const std::filesystem::path& file, const std::string& text);
std::optional<TiffDescription> omeDescription(const std::filesystem::path& file, const std::string& text);

}  // namespace freevoxels
