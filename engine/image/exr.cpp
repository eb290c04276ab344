// Reading and writing OpenEXR files. The bytes written depend on the image and the options only, not on time
// or host.

#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <half.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <new>

#include "engine/core/atomic_file.h"
#include "engine/core/error.h"
#include "engine/core/input_file.h"
#include "engine/core/printable.h"
#include "engine/image/exr_channels.h"
#include "engine/image/exr_claims.h"
#include "engine/image/exr_file.h"
#include "engine/image/image.h"

namespace freevoxels {

namespace {

constexpr std::array<const char*, 4> kColorChannels = {"R", "G", "B", "A"};
constexpr float kMaxHalf = 65504.0f;
constexpr std::size_t kPixelsATask = 1 << 14;
constexpr std::size_t kLongestReason = 200;  ///< of OpenEXR, bytes

/// Compression level, 1 to 9. Files are 4 to 8 % larger than with level 3, in nine tenths of the time.
constexpr int kZipLevel = 1;

Imf::Header makeHeader(const Image& image, const ExrOptions& options) {
  const glm::ivec2 whole = image.wholeSize.x > 0 ? image.wholeSize : image.size, last = image.offset + image.size - 1;
  Imf::Header header(Imath::Box2i({0, 0}, {whole.x - 1, whole.y - 1}),
                     Imath::Box2i({image.offset.x, image.offset.y}, {last.x, last.y}));
  header.compression() = Imf::ZIP_COMPRESSION;
  header.zipCompressionLevel() = kZipLevel;
  Imf::addChromaticities(header, Imf::Chromaticities());  // the default is Rec.709 with D65 white
  for (const char* name : kColorChannels)
    header.channels().insert(name, Imf::Channel(options.fullFloat ? Imf::FLOAT : Imf::HALF));
  if (!image.depth.empty()) header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
  for (const auto& [name, values] : image.channels) header.channels().insert(name, Imf::Channel(Imf::FLOAT));
  insertOptions(header, options);
  return header;
}

/// Converts to half. Values beyond its range become the largest half, not infinity.
std::vector<half> toHalf(const std::vector<glm::vec4>& pixels) {
  std::vector<half> halves(pixels.size() * 4);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, pixels.size(), kPixelsATask),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i < range.end(); ++i)
                        for (int c = 0; c < 4; ++c) halves[4 * i + std::size_t(c)] = half(std::clamp(pixels[i][c], -kMaxHalf, kMaxHalf));
                    });
  return halves;
}

/// A slice of a window of pixels, each of which has `channels` interleaved values of type T; `base` is the first one's.
template <typename T>
Imf::Slice makeSlice(Imf::PixelType type, const T* base, std::size_t channels, const Imath::Box2i& window, double fill = 0.0) {
  return Imf::Slice::Make(type, base, window, sizeof(T) * channels, 0, 1, 1, fill);
}

void encode(const std::filesystem::path& file, const Image& image, const ExrOptions& options) {
  const std::vector<half> halves = options.fullFloat ? std::vector<half>{} : toHalf(image.pixels);
  const Imf::Header header = makeHeader(image, options);
  const Imath::Box2i window = header.dataWindow();
  Imf::FrameBuffer frame;
  for (std::size_t c = 0; c < kColorChannels.size(); ++c)
    frame.insert(kColorChannels[c], options.fullFloat ? makeSlice(Imf::FLOAT, &image.pixels[0].x + c, 4, window)
                                                      : makeSlice(Imf::HALF, halves.data() + c, 4, window));
  if (!image.depth.empty()) frame.insert("Z", makeSlice(Imf::FLOAT, image.depth.data(), 1, window));
  for (const auto& [name, values] : image.channels) frame.insert(name, makeSlice(Imf::FLOAT, values.data(), 1, window));
  writeExrPixels(file, header, frame);
}

/// Fails where the header is of no image of which these channels are read.
void checkHeader(const std::filesystem::path& file, const Imf::Header& header, std::span<const std::string> names,
                 std::int64_t maximumPixels) {
  if (header.hasType() && header.type() != Imf::SCANLINEIMAGE && header.type() != Imf::TILEDIMAGE)
    fail(ErrorKind::Input, "cannot read '{}': it holds deep samples; flatten it first", file.string());
  const Imf::ChannelList& channels = header.channels();
  for (const std::string& name : names)
    if (const Imf::Channel* const channel = channels.findChannel(name); channel != nullptr && (channel->xSampling != 1 || channel->ySampling != 1))
      fail(ErrorKind::Input, "cannot read '{}': its channel {} has fewer samples than the image has pixels; write it with one a pixel",
           file.string(), printable(name));
  const Imath::Box2i window = header.dataWindow();
  const std::int64_t width = std::int64_t(window.max.x) - window.min.x + 1;
  const std::int64_t height = std::int64_t(window.max.y) - window.min.y + 1;
  if (width * height > maximumPixels)
    fail(ErrorKind::Input, "cannot read '{}': {}x{} pixels are too many; choose a smaller image",
         file.string(), width, height);
}

/// Calls read(band) for the rows of a window a band at a time, so that a file which ends early fails before the memory of all is taken.
template <typename Read>
void readBands(const Imath::Box2i& window, const Read& read) {
  constexpr std::int64_t kPixelsOfABand = 1 << 20;
  const std::int64_t rows = std::max<std::int64_t>(kPixelsOfABand / (std::int64_t(window.max.x) - window.min.x + 1), 1);
  for (std::int64_t first = window.min.y; first <= window.max.y; first += rows)
    read(Imath::Box2i({window.min.x, int(first)}, {window.max.x, int(std::min<std::int64_t>(first + rows - 1, window.max.y))}));
}

Image decode(const std::filesystem::path& file, std::int64_t maximumPixels) {
  useAllProcessors();
  checkExrClaims(file);
  Imf::MultiPartInputFile exr(file.c_str(), Imf::globalThreadCount(), false);
  const ExrColors colors = findColors(file, exr);
  const Imf::Header& header = exr.header(colors.part);
  checkHeader(file, header, std::array{colors.names[0], colors.names[1], colors.names[2], colors.names[3], colors.depth}, maximumPixels);
  Imf::InputPart part(exr, colors.part);
  const Imath::Box2i window = header.dataWindow();
  const bool hasDepth = !colors.depth.empty(), isGrey = colors.names[0] == colors.names[1];
  Image image;
  image.size = {window.max.x - window.min.x + 1, window.max.y - window.min.y + 1};
  const auto width = std::size_t(image.size.x);
  readBands(window, [&](const Imath::Box2i& band) {
    const std::size_t before = image.pixels.size(), after = before + width * std::size_t(band.max.y - band.min.y + 1);
    image.pixels.resize(after);
    Imf::FrameBuffer frame;
    for (std::size_t c = 0; c < colors.names.size(); ++c)
      if (!isGrey || c == 0 || c == 3)
        frame.insert(colors.names[c].empty() ? "A" : colors.names[c],
                     makeSlice(Imf::FLOAT, &image.pixels[before].x + c, 4, band, c == 3 ? 1.0 : 0.0));
    if (hasDepth) {
      image.depth.resize(after);
      frame.insert(colors.depth, makeSlice(Imf::FLOAT, &image.depth[before], 1, band));
    }
    part.setFrameBuffer(frame);
    part.readPixels(band.min.y, band.max.y);
  });
  if (isGrey)
    for (glm::vec4& pixel : image.pixels) pixel = {pixel.r, pixel.r, pixel.r, pixel.a};
  if (const std::optional<glm::dmat3> matrix = isGrey ? std::nullopt : toRec709(header))
    for (glm::vec4& pixel : image.pixels) pixel = glm::vec4(glm::vec3(*matrix * glm::dvec3(pixel)), pixel.a);
  return image;
}

Image decodeDepth(const std::filesystem::path& file, std::int64_t maximumPixels) {
  useAllProcessors();
  checkExrClaims(file);
  Imf::MultiPartInputFile exr(file.c_str(), Imf::globalThreadCount(), false);
  const ExrChannel depth = findDepth(file, exr);
  const Imf::Header& header = exr.header(depth.part);
  checkHeader(file, header, std::array{depth.name}, maximumPixels);
  Imf::InputPart part(exr, depth.part);
  const Imath::Box2i window = header.dataWindow(), display = header.displayWindow();
  Image image{.size = {window.max.x - window.min.x + 1, window.max.y - window.min.y + 1},
              .wholeSize = {display.max.x - display.min.x + 1, display.max.y - display.min.y + 1},
              .offset = {window.min.x - display.min.x, window.min.y - display.min.y}};
  readBands(window, [&](const Imath::Box2i& band) {
    const std::size_t before = image.depth.size();
    image.depth.resize(before + std::size_t(image.size.x) * std::size_t(band.max.y - band.min.y + 1));
    Imf::FrameBuffer frame;
    frame.insert(depth.name, makeSlice(Imf::FLOAT, &image.depth[before], 1, band));
    part.setFrameBuffer(frame);
    part.readPixels(band.min.y, band.max.y);
  });
  return image;
}

/// Calls `decodeFile` and names the file where OpenEXR fails.
template <typename Decode>
Image readFile(const std::filesystem::path& file, const Decode& decodeFile) {
  checkInputFile("image", file);
  try {
    return decodeFile();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {
    fail(ErrorKind::Input, "cannot read '{}': it is not a complete OpenEXR image ({}); write it again",
         file.string(), printablePart(e.what(), kLongestReason));
  }
}

}  // namespace

void writeExr(const std::filesystem::path& file, const Image& image, const ExrOptions& options) {
  FV_CHECK_LT(0, image.size.x);
  FV_CHECK_LT(0, image.size.y);
  FV_CHECK_EQ(image.pixels.size(), std::size_t(image.size.x) * std::size_t(image.size.y));
  if (!image.depth.empty()) FV_CHECK_EQ(image.depth.size(), image.pixels.size());
  for (const auto& [name, values] : image.channels) FV_CHECK_EQ(values.size(), image.pixels.size());
  writeAtomically(file, [&](const std::filesystem::path& temporary) { encode(temporary, image, options); });
}

Image readExr(const std::filesystem::path& file, std::int64_t maximumPixels) {
  return readFile(file, [&] { return decode(file, maximumPixels); });
}

Image readExrDepth(const std::filesystem::path& file, std::int64_t maximumPixels) {
  return readFile(file, [&] { return decodeDepth(file, maximumPixels); });
}

}  // namespace freevoxels
