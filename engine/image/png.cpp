// sRGB PNG in and out. The bytes written depend on the image only: no time chunk.

#include <png.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cmath>
#include <csetjmp>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <stdexcept>

#include "engine/core/atomic_file.h"
#include "engine/core/checked_file.h"
#include "engine/core/error.h"
#include "engine/core/input_file.h"
#include "engine/core/printable.h"
#include "engine/image/decode_png.h"
#include "engine/image/display.h"
#include "engine/image/srgb.h"

namespace freevoxels {

namespace {

constexpr std::int64_t kMaximumPixels = std::int64_t(1) << 30;

/// Compression level, 1 to 9. Rendered images are a quarter larger than with level 4, in two thirds of the time.
constexpr int kCompressionLevel = 2;

/// Receives the next bytes of the file; may throw.
using Sink = std::function<void(const std::uint8_t* bytes, std::size_t count)>;

/// The state of libpng's C callbacks. No exception may pass through libpng: it is stored here and rethrown by
/// `encode`.
struct PngTarget {
  const Sink& write;
  std::exception_ptr failure = nullptr;
};

void writeChunk(png_structp png, png_bytep bytes, std::size_t count) {
  auto* target = static_cast<PngTarget*>(png_get_io_ptr(png));
  try {
    target->write(bytes, count);
    return;
  } catch (...) {
    target->failure = std::current_exception();
  }
  png_error(png, "the write failed");  // outside of the catch block, which a long jump must not leave
}

[[noreturn]] void onError(png_structp png, png_const_charp message) {
  auto* target = static_cast<PngTarget*>(png_get_error_ptr(png));
  if (!target->failure) target->failure = std::make_exception_ptr(std::runtime_error(message));
  png_longjmp(png, 1);
}

void onWarning(png_structp, png_const_charp) {}

[[noreturn]] void onReadError(png_structp png, png_const_charp message) {
  *static_cast<std::string*>(png_get_error_ptr(png)) = message;
  png_longjmp(png, 1);
}

/// Decodes any PNG to straight RGBA with 8 bits a sample, or 16 for 16-bit files. Its members need no
/// destruction after a long jump.
class PngDecoder {
 public:
  /// Stores libpng's messages in `problem`.
  PngDecoder(std::FILE* file, std::string& problem)
      : png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, &problem, onReadError, onWarning)) {
    if (png_) info_ = png_create_info_struct(png_);
    if (!info_) {
      png_destroy_read_struct(&png_, &info_, nullptr);
      throw std::bad_alloc();
    }
    png_init_io(png_, file);
  }
  ~PngDecoder() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngDecoder(const PngDecoder&) = delete;
  PngDecoder& operator=(const PngDecoder&) = delete;

  /// False after an error.
  bool readHeader() {
    if (setjmp(png_jmpbuf(png_))) return false;
    png_set_user_limits(png_, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_read_info(png_, info_);
    return true;
  }
  /// Takes memory for rows, and converts what is read. False after an error.
  bool begin() {
    if (setjmp(png_jmpbuf(png_))) return false;
    png_set_expand(png_);
    png_set_gray_to_rgb(png_);
    png_set_add_alpha(png_, 0xffff, PNG_FILLER_AFTER);
    if constexpr (std::endian::native == std::endian::little) png_set_swap(png_);
    png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    return true;
  }
  std::int64_t width() const { return png_get_image_width(png_, info_); }
  std::int64_t height() const { return png_get_image_height(png_, info_); }
  bool isWide() const { return png_get_bit_depth(png_, info_) == 16; }
  bool isInterlaced() const { return png_get_interlace_type(png_, info_) != PNG_INTERLACE_NONE; }
  /// Before begin(), of a row in the file, before it is compressed; afterwards, of what is read.
  std::size_t rowBytes() const { return png_get_rowbytes(png_, info_); }

  /// Reads the next rows; all of them of an interlaced image. False after an error.
  bool read(std::span<png_bytep> rows) {
    if (setjmp(png_jmpbuf(png_))) return false;
    if (isInterlaced())
      png_read_image(png_, rows.data());
    else
      png_read_rows(png_, rows.data(), nullptr, png_uint_32(rows.size()));
    return true;
  }
  /// What is behind the last row. False after an error.
  bool readEnd() {
    if (setjmp(png_jmpbuf(png_))) return false;
    png_read_end(png_, nullptr);
    return true;
  }

 private:
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
};

/// Appends straight RGBA samples as premultiplied linear light.
template <typename Sample>
class LinearPixels {
 public:
  LinearPixels() {
    for (std::size_t i = 0; i < kLevels; ++i) linear_.push_back(linearFromSrgb(float(i) / float(kLevels - 1)));
  }
  void append(std::span<const std::uint8_t> bytes, std::vector<glm::vec4>& pixels) const {
    std::array<Sample, 4> sample;
    for (std::size_t at = 0; at < bytes.size(); at += sizeof(sample)) {
      std::memcpy(sample.data(), &bytes[at], sizeof(sample));
      const float alpha = float(sample[3]) / float(kLevels - 1);
      pixels.emplace_back(alpha * linear_[sample[0]], alpha * linear_[sample[1]], alpha * linear_[sample[2]], alpha);
    }
  }

 private:
  static constexpr std::size_t kLevels = std::size_t(std::numeric_limits<Sample>::max()) + 1;
  std::vector<float> linear_;
};

/// Reads the rows a band at a time, so that a file which ends early fails before the memory of all is taken. False after an error.
template <typename Sample>
bool decodeRows(PngDecoder& decoder, Image& image) {
  constexpr std::int64_t kPixelsOfABand = 1 << 20;
  const LinearPixels<Sample> linear;
  const std::int64_t height = decoder.height(), band = decoder.isInterlaced() ? height : std::clamp<std::int64_t>(kPixelsOfABand / decoder.width(), 1, height);
  std::vector<std::uint8_t> bytes(decoder.rowBytes() * std::size_t(band));
  std::vector<png_bytep> rows;
  for (std::size_t y = 0; y < std::size_t(band); ++y) rows.push_back(bytes.data() + y * decoder.rowBytes());
  for (std::int64_t first = 0; first < height; first += band) {
    const auto count = std::size_t(std::min(band, height - first));
    if (!decoder.read(std::span(rows).first(count))) return false;
    linear.append(std::span(bytes).first(count * decoder.rowBytes()), image.pixels);
  }
  return decoder.readEnd();
}

Image decode(const std::string& name, std::FILE* stream, std::uint64_t fileBytes) {
  std::string problem;
  const auto refuse = [&]() {
    fail(ErrorKind::Input, "cannot read '{}': it is not a complete PNG image ({}); write it again", name, printable(problem));
  };
  PngDecoder decoder(stream, problem);
  if (!decoder.readHeader()) refuse();
  if (decoder.width() * decoder.height() > kMaximumPixels)
    fail(ErrorKind::Input, "cannot read '{}': {}x{} pixels are too many; choose a smaller image", name, decoder.width(), decoder.height());
  constexpr double kMaxShrinking = 1100.0;  // Deflate reaches 1032
  if (double(decoder.rowBytes()) * double(decoder.height()) > kMaxShrinking * double(fileBytes))
    fail(ErrorKind::Input, "cannot read '{}': its header claims {}x{} pixels, which a file of {} bytes cannot hold; write it again", name,
         decoder.width(), decoder.height(), fileBytes);
  if (!decoder.begin()) refuse();

  Image image;
  image.size = {int(decoder.width()), int(decoder.height())};
  image.pixels.reserve(std::size_t(decoder.width() * decoder.height()));
  if (!(decoder.isWide() ? decodeRows<std::uint16_t>(decoder, image) : decodeRows<std::uint8_t>(decoder, image))) refuse();
  return image;
}

/// An image as it is stored, samples of 16 bits in the byte order of this machine.
struct Samples {
  glm::ivec2 size;
  int channels, bits;
  const std::uint8_t* bytes;

  std::size_t rowBytes() const { return std::size_t(size.x) * std::size_t(channels) * std::size_t(bits / 8); }
};

class PngEncoder {
 public:
  explicit PngEncoder(PngTarget& target)
      : png_(png_create_write_struct(PNG_LIBPNG_VER_STRING, &target, onError, onWarning)) {
    if (png_) info_ = png_create_info_struct(png_);
    if (!info_) {
      png_destroy_write_struct(&png_, &info_);
      throw std::bad_alloc();
    }
    png_set_write_fn(png_, &target, writeChunk, [](png_structp) {});
  }
  ~PngEncoder() { png_destroy_write_struct(&png_, &info_); }
  PngEncoder(const PngEncoder&) = delete;
  PngEncoder& operator=(const PngEncoder&) = delete;

  /// Returns false after an error. Has no local objects that a long jump would fail to destroy.
  bool write(const Samples& samples) {
    if (setjmp(png_jmpbuf(png_))) return false;
    png_set_user_limits(png_, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_set_IHDR(png_, info_, png_uint_32(samples.size.x), png_uint_32(samples.size.y), samples.bits,
                 samples.channels == 4 ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB_gAMA_and_cHRM(png_, info_, PNG_sRGB_INTENT_PERCEPTUAL);
    // Trying all five filters in every row takes longer than compressing it and saves nothing, since rendered
    // images are smooth or empty.
    png_set_filter(png_, PNG_FILTER_TYPE_BASE, PNG_FILTER_UP);
    png_set_compression_level(png_, kCompressionLevel);
    png_write_info(png_, info_);
    if (samples.bits == 16 && std::endian::native == std::endian::little) png_set_swap(png_);
    for (std::size_t y = 0; y < std::size_t(samples.size.y); ++y) png_write_row(png_, samples.bytes + y * samples.rowBytes());
    png_write_end(png_, info_);
    return true;
  }

 private:
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
};

void encode(const Samples& samples, const Sink& sink) {
  FV_CHECK_LT(0, samples.size.x);
  FV_CHECK_LT(0, samples.size.y);
  PngTarget target{sink};
  PngEncoder encoder(target);
  if (!encoder.write(samples)) std::rethrow_exception(target.failure);
}

template <typename Sample>
void encodeSamples(const Image& image, const DisplayLook& look, const Sink& sink) {
  FV_CHECK_EQ(image.pixels.size(), std::size_t(image.size.x) * std::size_t(image.size.y));
  const std::vector<Sample> samples = displaySamples<Sample>(image, look);
  encode({.size = image.size,
          .channels = displayChannels(look),
          .bits = 8 * int(sizeof(Sample)),
          .bytes = reinterpret_cast<const std::uint8_t*>(samples.data())},
         sink);
}

void encodeAs(const Image& image, const DisplayLook& look, int bits, const Sink& sink) {
  FV_CHECK_EQ(bits == 8 || bits == 16, true);
  if (bits == 16)
    encodeSamples<std::uint16_t>(image, look, sink);
  else
    encodeSamples<std::uint8_t>(image, look, sink);
}

/// Atomic.
void writeFile(const std::filesystem::path& file, const std::function<void(const Sink&)>& encodeInto) {
  writeAtomically(file, [&](const std::filesystem::path& temporary) {
    CheckedFile output(temporary);
    encodeInto([&](const std::uint8_t* bytes, std::size_t count) { output.write(bytes, count); });
    output.close();
  });
}

}  // namespace

Image readPng(const std::filesystem::path& file) {
  checkInputFile("image", file);
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(file.c_str(), "rb"), std::fclose);
  if (!stream)
    fail(ErrorKind::Input, "cannot read '{}': {}; check its permissions", file.string(), std::strerror(errno));
  return decode(file.string(), stream.get(), std::filesystem::file_size(file));
}

Image decodePng(const std::string& name, std::span<const std::uint8_t> file) {
  // The stream only reads the bytes.
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(fmemopen(const_cast<std::uint8_t*>(file.data()), file.size(), "rb"),
                                                               std::fclose);
  if (!stream) throw std::bad_alloc();
  return decode(name, stream.get(), file.size());
}

std::vector<std::uint8_t> srgbTexels(const Image& image, const DisplayLook& look) {
  const std::vector<std::uint8_t> bytes = displaySamples<std::uint8_t>(image, look);
  if (!look.background) return bytes;
  std::vector<std::uint8_t> texels(image.pixels.size() * 4, 255);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    std::copy_n(bytes.data() + 3 * i, 3, texels.data() + 4 * i);
  return texels;
}

std::vector<std::uint8_t> encodePng(const Image& image, const DisplayLook& look, int bits) {
  std::vector<std::uint8_t> file;
  encodeAs(image, look, bits, [&](const std::uint8_t* bytes, std::size_t count) {
    file.insert(file.end(), bytes, bytes + count);
  });
  return file;
}

void writePng(const std::filesystem::path& file, const Image& image, const DisplayLook& look, int bits) {
  writeFile(file, [&](const Sink& sink) { encodeAs(image, look, bits, sink); });
}

void writePngTexels(const std::filesystem::path& file, glm::ivec2 size,
                    std::span<const std::uint8_t> texels) {
  FV_CHECK_EQ(texels.size(), 4 * std::size_t(size.x) * std::size_t(size.y));
  std::vector<std::uint8_t> opaque;
  opaque.reserve(texels.size() / 4 * 3);
  for (std::size_t i = 0; i < texels.size(); i += 4)
    opaque.insert(opaque.end(), texels.begin() + std::ptrdiff_t(i), texels.begin() + std::ptrdiff_t(i) + 3);
  writeFile(file, [&](const Sink& sink) { encode({.size = size, .channels = 3, .bits = 8, .bytes = opaque.data()}, sink); });
}

}  // namespace freevoxels
