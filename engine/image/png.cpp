// 8-bit sRGB PNG out. The bytes written depend on the image only: no time chunk.

#include <png.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csetjmp>
#include <cstdint>
#include <exception>
#include <stdexcept>

#include "engine/core/atomic_file.h"
#include "engine/core/checked_file.h"
#include "engine/core/error.h"
#include "engine/image/image.h"

namespace freevoxels {

namespace {

/// 0 for NaN.
float clampUnit(float value) {
  return value > 0.0f ? std::min(value, 1.0f) : 0.0f;
}

std::uint8_t toByte(float unit) {
  return std::uint8_t(std::lround(255.0f * unit));
}

/// The transfer curve of IEC 61966-2-1.
std::uint8_t toSrgbByte(float linear) {
  const float unit = clampUnit(linear);
  return toByte(unit <= 0.0031308f ? 12.92f * unit : 1.055f * std::pow(unit, 1.0f / 2.4f) - 0.055f);
}

/// Alpha above 1, which the additive composite makes, counts as 1.
std::vector<std::uint8_t> toBytes(const Image& image, const glm::vec3* background) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(image.pixels.size() * (background ? 3 : 4));
  for (const glm::vec4& pixel : image.pixels) {
    const float alpha = clampUnit(pixel.a);
    for (int c = 0; c < 3; ++c) {
      const float straight = alpha > 0.0f ? pixel[c] / alpha : 0.0f;
      bytes.push_back(toSrgbByte(background ? pixel[c] + (1.0f - alpha) * (*background)[c] : straight));
    }
    if (!background) bytes.push_back(toByte(alpha));
  }
  return bytes;
}

/// What libpng's C callbacks know. No exception may cross libpng: it is kept here and thrown by `encode`.
struct PngTarget {
  CheckedFile& file;
  std::exception_ptr failure = nullptr;
};

void writeChunk(png_structp png, png_bytep bytes, std::size_t count) {
  auto* target = static_cast<PngTarget*>(png_get_io_ptr(png));
  try {
    target->file.write(bytes, count);
    return;
  } catch (...) {
    target->failure = std::current_exception();
  }
  png_error(png, "the write failed");  // outside of the handler, which a long jump must not leave
}

[[noreturn]] void onError(png_structp png, png_const_charp message) {
  auto* target = static_cast<PngTarget*>(png_get_error_ptr(png));
  if (!target->failure) target->failure = std::make_exception_ptr(std::runtime_error(message));
  png_longjmp(png, 1);
}

void onWarning(png_structp, png_const_charp) {}

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

  /// False after an error. Holds nothing that a long jump would fail to destroy.
  bool write(glm::ivec2 size, int channels, const std::uint8_t* bytes) {
    if (setjmp(png_jmpbuf(png_))) return false;
    png_set_user_limits(png_, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_set_IHDR(png_, info_, png_uint_32(size.x), png_uint_32(size.y), 8,
                 channels == 4 ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB_gAMA_and_cHRM(png_, info_, PNG_sRGB_INTENT_PERCEPTUAL);
    png_write_info(png_, info_);
    for (std::size_t y = 0; y < std::size_t(size.y); ++y)
      png_write_row(png_, bytes + y * std::size_t(size.x) * std::size_t(channels));
    png_write_end(png_, info_);
    return true;
  }

 private:
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
};

}  // namespace

void writePng(const std::filesystem::path& file, const Image& image, const glm::vec3* background) {
  FV_CHECK_LT(0, image.size.x);
  FV_CHECK_LT(0, image.size.y);
  FV_CHECK_EQ(image.pixels.size(), std::size_t(image.size.x) * std::size_t(image.size.y));
  writeAtomically(file, [&](const std::filesystem::path& temporary) {
    const std::vector<std::uint8_t> bytes = toBytes(image, background);
    CheckedFile output(temporary);
    PngTarget target{output};
    PngEncoder encoder(target);
    if (!encoder.write(image.size, background ? 3 : 4, bytes.data())) std::rethrow_exception(target.failure);
    output.close();
  });
}

}  // namespace freevoxels
