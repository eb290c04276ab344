#pragma once
// Images in memory, and reading and writing image files.

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace freevoxels {

/// Pixels of an edge of an image that is drawn.
inline constexpr int kMaxImageEdge = 16384;

struct Image {
  glm::ivec2 size{0};
  std::vector<glm::vec4> pixels;  ///< linear Rec.709, premultiplied alpha; row 0 is the top
  /// Empty, or one value a pixel: the mean distance from the eye along the viewing axis, in world units, of
  /// what is seen there (apps/manual/images.md); +infinity where nothing is seen.
  std::vector<float> depth;
  std::map<std::string, std::vector<float>> channels;  ///< more of them by name, "N.X": one value a pixel
  /// If this image is a part of another one: the size of the whole, and the position of this one's top left pixel in it. Pixels.
  glm::ivec2 wholeSize{0}, offset{0};
};

/// The memory of all its values.
inline std::uint64_t bytesOf(const Image& image) {
  std::uint64_t values = 4 * image.pixels.size() + image.depth.size();
  for (const auto& [name, channel] : image.channels) values += channel.size();
  return values * sizeof(float);
}

/// Pixels of an image.
struct PixelRectangle {
  glm::ivec2 corner{0};  ///< top left
  glm::ivec2 size{0};
};

/// The part of a whole image; `part` lies in it.
Image cropped(const Image& image, const PixelRectangle& part);

struct ExrOptions {
  bool fullFloat = false;  ///< 32-bit RGBA; otherwise half. Z is always 32-bit.
  std::map<std::string, std::string> metadata;
  /// "worldToCamera" and "worldToNDC" in glm's convention (matrix * column). The file stores OpenEXR's (row *
  /// matrix).
  std::map<std::string, glm::mat4> matrices;
};

/// RGBA, Z where there is depth, and the more channels, of 32 bits. A part of an image is the data window in the display window of the
/// whole. Atomic. Fails with ErrorKind::Output.
void writeExr(const std::filesystem::path& file, const Image& image, const ExrOptions& options);

/// Reads RGBA and, if present, Z of the data window of a scanline EXR of at most `maximumPixels` pixels.
/// Memory is allocated for the data that is there, so that a short file cannot cause the allocation that its
/// header claims. Fails with ErrorKind::Input.
Image readExr(const std::filesystem::path& file, std::int64_t maximumPixels = std::int64_t(1) << 30);

/// Reads the depths of such a file alone, whatever colours it has: channel Z, that of a layer called depth, or the only channel. The image
/// has `depth` but no pixels, and is that part of `wholeSize`, the display window, which the data window is. Fails with ErrorKind::Input.
Image readExrDepth(const std::filesystem::path& file, std::int64_t maximumPixels = std::int64_t(1) << 28);

/// Reads any PNG (grey, palette, 8 or 16 bits, interlaced) as sRGB with straight alpha, whatever its chunks
/// say. Fails with ErrorKind::Input.
Image readPng(const std::filesystem::path& file);

/// Reads a Radiance picture (.hdr): linear Rec.709, opaque. Fails with ErrorKind::Input.
Image readHdr(const std::filesystem::path& file, std::int64_t maximumPixels = std::int64_t(1) << 30);
/// Whether the file begins as a Radiance picture does; false if it cannot be read.
bool isHdr(const std::filesystem::path& file);

/// Calls readExr, readHdr or readPng, by the first bytes of the file, not by its name. Fails with ErrorKind::Input.
Image readImage(const std::filesystem::path& file);

/// The background of an image, linear Rec.709, interpolated linearly from the top edge to the bottom edge.
struct Background {
  glm::vec3 top{0.0f}, bottom{0.0f};
};

/// The curve that maps linear light to 0..1. Filmic: Hable's curve (2010), white at 11.2. Aces: Narkowicz's
/// fit (2015).
enum class ToneMap : int { None = 0, Filmic = 1, Aces = 2 };

/// How an image is shown.
struct DisplayLook {
  std::optional<Background> background;  ///< if there is none, the file has straight alpha
  double exposure = 0.0;                 ///< in stops, applied to the image but not to the background
  ToneMap toneMap = ToneMap::None;       ///< applied to each channel after the exposure
};

/// sRGB of 8 or 16 bits a sample. Straight alpha without a background; composited over it and opaque with one. Atomic. Fails
/// with ErrorKind::Output.
void writePng(const std::filesystem::path& file, const Image& image, const DisplayLook& look = {}, int bits = 8);

/// 8-bit sRGB over the background, or over black. Atomic. Fails with ErrorKind::Output.
void writeJpeg(const std::filesystem::path& file, const Image& image, const DisplayLook& look = {});

/// The pixels that writePng writes, 4 bytes each.
std::vector<std::uint8_t> srgbTexels(const Image& image, const DisplayLook& look = {});

/// Writes such texels as an opaque image, ignoring their alpha. Atomic. Fails with ErrorKind::Output.
void writePngTexels(const std::filesystem::path& file, glm::ivec2 size, std::span<const std::uint8_t> texels);

/// The bytes of the file that writePng writes.
std::vector<std::uint8_t> encodePng(const Image& image, const DisplayLook& look = {}, int bits = 8);

}  // namespace freevoxels
