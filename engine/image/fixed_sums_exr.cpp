// Files of sums: OpenEXR with 32-bit integer channels.

#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfIntAttribute.h>
#include <ImfMatrixAttribute.h>
#include <ImfMultiPartInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>

#include <algorithm>
#include <new>
#include <string_view>

#include "engine/core/atomic_file.h"
#include "engine/core/error.h"
#include "engine/core/printable.h"
#include "engine/image/exr_claims.h"
#include "engine/image/exr_file.h"
#include "engine/image/fixed_sums.h"

namespace freevoxels {

namespace {

constexpr std::array<const char*, kSumChannels> kNames{"red", "green", "blue", "energy", "depth", "distance"};
constexpr int kMostDigits = 512;  ///< more than any sum has, and few enough for numbers of double precision
constexpr const char* kMethod = "freevoxels:method";
constexpr const char* kLattice = "freevoxels:lattice";  ///< only where the sums are those of samples

std::string digitsName(int channel) {
  return fmt::format("freevoxels:digits.{}", kNames[std::size_t(channel)]);
}

/// Rows of the rectangle of sums.
struct Rows {
  int first, count;
};

/// The high and the low words of the values of some rows, as a file's channels have them.
struct Words {
  std::vector<std::uint32_t> high, low;
};

/// Slices of both words of every channel, addressed in the image's coordinates.
Imf::FrameBuffer frameBuffer(Words& words, const FixedSums& sums, Rows rows) {
  Imf::FrameBuffer frame;
  const auto stride = std::size_t(sums.extent.x) * sizeof(std::uint32_t);
  const std::ptrdiff_t before = (std::ptrdiff_t(sums.first.y) + rows.first) * sums.extent.x + sums.first.x;
  for (int c = 0; c < sums.channels; ++c) {
    const std::ptrdiff_t place = std::ptrdiff_t(c) * sums.extent.x * rows.count - before;
    const auto insert = [&](const char* part, std::vector<std::uint32_t>& data) {
      frame.insert(fmt::format("{}.{}", kNames[std::size_t(c)], part),
                   Imf::Slice(Imf::UINT, reinterpret_cast<char*>(data.data() + place), sizeof(std::uint32_t), stride));
    };
    insert("high", words.high);
    insert("low", words.low);
  }
  return frame;
}

Imf::Header makeHeader(const FixedSums& sums, const ExrOptions& options) {
  const Imath::Box2i display({0, 0}, {sums.size.x - 1, sums.size.y - 1});
  const glm::ivec2 last = sums.first + sums.extent - 1;
  Imf::Header header(display, {{sums.first.x, sums.first.y}, {last.x, last.y}});
  header.compression() = Imf::ZIP_COMPRESSION;
  for (int c = 0; c < sums.channels; ++c) {
    for (const char* part : {"high", "low"})
      header.channels().insert(fmt::format("{}.{}", kNames[std::size_t(c)], part), Imf::Channel(Imf::UINT));
    header.insert(digitsName(c), Imf::IntAttribute(sums.digits[std::size_t(c)]));
  }
  header.insert(kMethod, Imf::StringAttribute(sums.method));
  if (sums.lattice) header.insert(kLattice, Imf::StringAttribute(latticeText(*sums.lattice)));
  insertOptions(header, options);
  return header;
}

void encode(const std::filesystem::path& file, const FixedSums& sums, const ExrOptions& options) {
  Words words{std::vector<std::uint32_t>(sums.values.size()), std::vector<std::uint32_t>(sums.values.size())};
  for (std::size_t i = 0; i < sums.values.size(); ++i) {
    words.high[i] = std::uint32_t(std::uint64_t(sums.values[i]) >> 32);
    words.low[i] = std::uint32_t(std::uint64_t(sums.values[i]));
  }
  writeExrPixels(file, makeHeader(sums, options), frameBuffer(words, sums, {0, sums.extent.y}));
}

bool hasChannels(const Imf::Header& header) {
  return header.channels().findChannel("energy.high") != nullptr && header.channels().findChannel("energy.low") != nullptr;
}

FixedSums readLayout(const std::filesystem::path& file, const Imf::Header& header) {
  const auto refuse = [&](const char* what) {
    fail(ErrorKind::Input, "cannot read '{}': {}; render this share again", file.string(), what);
  };
  const Imath::Box2i window = header.dataWindow(), display = header.displayWindow();
  if (display.min.x != 0 || display.min.y != 0 || display.max.x < 0 || display.max.y < 0 || display.max.x >= kMaxImageEdge ||
      display.max.y >= kMaxImageEdge)
    refuse("its image has an impossible size");
  FixedSums sums{.size = {display.max.x + 1, display.max.y + 1}};
  const bool hasDistance = header.channels().findChannel("distance.high") != nullptr;
  if (const auto* lattice = header.findTypedAttribute<Imf::StringAttribute>(kLattice)) {
    sums.lattice = latticeOf(lattice->value());
    if (!hasDistance || sums.lattice->pitch < leastPitch(sums.size) || sums.lattice->samples != latticeSamples(sums.size, sums.lattice->pitch))
      refuse("its lattice of samples is not one of its image");
  }
  const glm::ivec2 full = sums.fullSize();
  if (window.min.x < 0 || window.min.y < 0 || window.max.x < window.min.x || window.max.y < window.min.y || window.max.x >= full.x ||
      window.max.y >= full.y)
    refuse("its rectangle of sums is not inside of its image");
  sums.first = {window.min.x, window.min.y};
  sums.extent = glm::ivec2(window.max.x, window.max.y) - sums.first + 1;
  sums.channels = hasDistance ? kSumChannels : kSumChannels - 1;
  for (int c = 0; c < sums.channels; ++c) {
    for (const char* part : {"high", "low"}) {
      // A channel of fewer pixels than the window would not vouch for the size of the image.
      const Imf::Channel* const channel = header.channels().findChannel(fmt::format("{}.{}", kNames[std::size_t(c)], part));
      if (channel == nullptr || channel->type != Imf::UINT || channel->xSampling != 1 || channel->ySampling != 1)
        refuse("its channels are not those of sums");
    }
    std::int32_t& digits = sums.digits[std::size_t(c)];
    digits = header.typedAttribute<Imf::IntAttribute>(digitsName(c)).value();
    if (digits < -kMostDigits || digits > kMostDigits) refuse("its sums have an impossible number of digits");
  }
  sums.method = header.typedAttribute<Imf::StringAttribute>(kMethod).value();
  return sums;
}

/// Reads the rows a band at a time, from the last ones on, so that a file which ends early fails before the memory of all sums is taken.
void readValues(Imf::InputPart& part, FixedSums& sums) {
  constexpr int kPixelsOfABand = 1 << 18, kRowsOfAChunk = 16;
  const int rowsOfABand = std::max(kPixelsOfABand / sums.extent.x / kRowsOfAChunk, 1) * kRowsOfAChunk;
  const auto width = std::size_t(sums.extent.x), channels = std::size_t(sums.channels);
  Words words;
  for (int first = (sums.extent.y - 1) / rowsOfABand * rowsOfABand; first >= 0; first -= rowsOfABand) {
    const Rows rows{first, std::min(rowsOfABand, sums.extent.y - first)};
    const std::size_t pixels = width * std::size_t(rows.count);
    words.high.resize(pixels * channels);
    words.low.resize(pixels * channels);
    part.setFrameBuffer(frameBuffer(words, sums, rows));
    part.readPixels(sums.first.y + rows.first, sums.first.y + rows.first + rows.count - 1);
    sums.values.resize(sums.pixelCount() * channels);
    for (std::size_t c = 0; c < channels; ++c) {
      std::int64_t* const values = &sums.values[c * sums.pixelCount() + width * std::size_t(rows.first)];
      for (std::size_t i = 0; i < pixels; ++i)
        values[i] = std::int64_t(std::uint64_t(words.high[c * pixels + i]) << 32 | words.low[c * pixels + i]);
    }
  }
}

SumsFile decode(const std::filesystem::path& file) {
  useAllProcessors();
  checkExrClaims(file);
  // Allocates nothing for pixels before the header is known to be one of sums.
  Imf::MultiPartInputFile exr(file.c_str(), Imf::globalThreadCount(), false);
  const Imf::Header& header = exr.header(0);
  if (!hasChannels(header))
    fail(ErrorKind::Input, "cannot read '{}' as sums: it is an image; write sums with 'freevoxels render {} {}'",
         file.string(), Parameter("share", "I/N"), Parameter("sums"));
  SumsFile result{.sums = readLayout(file, header), .header = readOptions(header)};
  Imf::InputPart part(exr, 0);
  readValues(part, result.sums);
  return result;
}

/// What `read` returns; OpenEXR's exceptions become one sentence about the file.
template <typename Read>
auto guarded(const std::filesystem::path& file, const Read& read) {
  try {
    return read();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    constexpr std::size_t kLongest = 200;
    fail(ErrorKind::Input, "cannot read '{}': it is not a complete OpenEXR file of sums ({}); render this share again", file.string(),
         printablePart(error.what(), kLongest));
  }
}

}  // namespace

void writeSums(const std::filesystem::path& file, const FixedSums& sums, const ExrOptions& header) {
  FV_CHECK_EQ(sums.values.size(), sums.pixelCount() * std::size_t(sums.channels));
  writeAtomically(file, [&](const std::filesystem::path& temporary) { encode(temporary, sums, header); });
}

SumsFile readSums(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error))
    fail(ErrorKind::Input, "cannot read '{}': there is no such file; check its name", file.string());
  return guarded(file, [&] { return decode(file); });
}

bool holdsSums(const std::filesystem::path& file) {
  return guarded(file, [&] {
    checkExrClaims(file);
    return hasChannels(Imf::MultiPartInputFile(file.c_str(), Imf::globalThreadCount(), false).header(0));
  });
}

}  // namespace freevoxels
