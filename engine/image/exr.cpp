// Reading and writing OpenEXR files. The bytes written depend on the image and the options only, not on time
// or host.

#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
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
#include "engine/image/exr_file.h"
#include "engine/image/image.h"

namespace freevoxels {

namespace {

constexpr std::array<const char*, 4> kColorChannels = {"R", "G", "B", "A"};
constexpr float kLargestHalf = 65504.0f;
constexpr std::size_t kPixelsATask = 1 << 14;

/// Compression level, 1 to 9. Files are at most a tenth larger than with OpenEXR's default 4, in two thirds
/// of the time.
constexpr int kZipLevel = 3;

Imf::Header makeHeader(const Image& image, const ExrOptions& options) {
  Imf::Header header(image.size.x, image.size.y);
  header.compression() = Imf::ZIP_COMPRESSION;
  header.zipCompressionLevel() = kZipLevel;
  Imf::addChromaticities(header, Imf::Chromaticities());  // the default is Rec.709 with D65 white
  for (const char* name : kColorChannels)
    header.channels().insert(name, Imf::Channel(options.fullFloat ? Imf::FLOAT : Imf::HALF));
  if (!image.depth.empty()) header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
  insertOptions(header, options);
  return header;
}

/// Converts to half. Values beyond its range become the largest half, not infinity.
std::vector<half> toHalf(const std::vector<glm::vec4>& pixels) {
  std::vector<half> halves(pixels.size() * 4);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, pixels.size(), kPixelsATask),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i < range.end(); ++i)
                        for (int c = 0; c < 4; ++c)
                          halves[4 * i + std::size_t(c)] =
                              half(std::clamp(pixels[i][c], -kLargestHalf, kLargestHalf));
                    });
  return halves;
}

/// A slice of interleaved pixels of `channels` values of type T.
template <typename T>
Imf::Slice makeSlice(Imf::PixelType type, const T* base, std::size_t channels, std::size_t width,
                     double fill = 0.0) {
  return Imf::Slice(type, reinterpret_cast<char*>(const_cast<T*>(base)), sizeof(T) * channels,
                    sizeof(T) * channels * width, 1, 1, fill);
}

void encode(const std::filesystem::path& file, const Image& image, const ExrOptions& options) {
  const std::size_t width = std::size_t(image.size.x);
  const std::vector<half> halves = options.fullFloat ? std::vector<half>{} : toHalf(image.pixels);
  Imf::FrameBuffer frame;
  for (std::size_t c = 0; c < kColorChannels.size(); ++c)
    frame.insert(kColorChannels[c], options.fullFloat
                                        ? makeSlice(Imf::FLOAT, &image.pixels[0].x + c, 4, width)
                                        : makeSlice(Imf::HALF, halves.data() + c, 4, width));
  if (!image.depth.empty()) frame.insert("Z", makeSlice(Imf::FLOAT, image.depth.data(), 1, width));
  writeExrPixels(file, makeHeader(image, options), frame);
}

Image decode(const std::filesystem::path& file, std::int64_t maximumPixels) {
  Imf::InputFile exr(file.c_str());
  const Imf::ChannelList& channels = exr.header().channels();
  if (!channels.findChannel("R") || !channels.findChannel("G") || !channels.findChannel("B"))
    fail(ExitCode::Input, "cannot read '{}': it has no channels R, G and B; choose a colour image",
         file.string());
  const Imath::Box2i window = exr.header().dataWindow();
  const std::int64_t width = std::int64_t(window.max.x) - window.min.x + 1;
  const std::int64_t height = std::int64_t(window.max.y) - window.min.y + 1;
  if (width * height > maximumPixels)
    fail(ExitCode::Input, "cannot read '{}': {}x{} pixels are too many; choose a smaller image",
         file.string(), width, height);

  Image image;
  image.size = {int(width), int(height)};
  image.pixels.resize(std::size_t(width * height));
  // Slices are addressed by the coordinates of the data window, which need not start at 0.
  const auto first = -(std::ptrdiff_t(window.min.y) * width + window.min.x);
  Imf::FrameBuffer frame;
  for (std::size_t c = 0; c < kColorChannels.size(); ++c)
    frame.insert(kColorChannels[c], makeSlice(Imf::FLOAT, &image.pixels[0].x + c + 4 * first, 4,
                                              std::size_t(width), c == 3 ? 1.0 : 0.0));
  if (channels.findChannel("Z")) {
    image.depth.resize(image.pixels.size());
    frame.insert("Z", makeSlice(Imf::FLOAT, image.depth.data() + first, 1, std::size_t(width)));
  }
  exr.setFrameBuffer(frame);
  exr.readPixels(window.min.y, window.max.y);
  return image;
}

}  // namespace

void writeExr(const std::filesystem::path& file, const Image& image, const ExrOptions& options) {
  FV_CHECK_LT(0, image.size.x);
  FV_CHECK_LT(0, image.size.y);
  FV_CHECK_EQ(image.pixels.size(), std::size_t(image.size.x) * std::size_t(image.size.y));
  if (!image.depth.empty()) FV_CHECK_EQ(image.depth.size(), image.pixels.size());
  writeAtomically(file, [&](const std::filesystem::path& temporary) { encode(temporary, image, options); });
}

Image readExr(const std::filesystem::path& file, std::int64_t maximumPixels) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error))
    fail(ExitCode::Input, "cannot read '{}': there is no such file; check its name", file.string());
  try {
    return decode(file, maximumPixels);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {
    fail(ExitCode::Input, "cannot read '{}': it is not a complete OpenEXR image ({}); write it again",
         file.string(), e.what());
  }
}

}  // namespace freevoxels
