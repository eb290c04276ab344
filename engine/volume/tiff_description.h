#pragma once
// Internal to the reader of TIFF: what the description of the first page says of all pages, as ImageJ and OME write it.

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
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
  bool isInMillimetres = false;                   ///< whether it says a unit of lengths
  std::vector<ScanChannel> described;             ///< as many as channels, or none

  std::uint64_t planes() const { return std::uint64_t(channels) * std::uint64_t(slices) * std::uint64_t(frames); }
  /// The place of a plane among all.
  std::uint64_t planeAt(int channel, int slice, int frame) const;
};

/// Nothing where the text is no such description. Fails with ErrorKind::Input where it is one and is damaged.
std::optional<TiffDescription> imageJDescription(const std::filesystem::path& file, const std::string& text);
/// Gives the channels the colours at the ends of the look-up tables that ImageJ has them in, and their display ranges as windows:
/// `metadata` are the values of its tag of parts, and `counts` those of its tag of their lengths. Leaves the channels as they are where
/// these are something else.
void takeImageJLooks(std::span<const std::byte> metadata, std::span<const std::uint32_t> counts, TiffDescription& description);
/// `components`: numbers of a pixel, which OME counts as channels.
std::optional<TiffDescription> omeDescription(const std::filesystem::path& file, const std::string& text, int components);

}  // namespace freevoxels
