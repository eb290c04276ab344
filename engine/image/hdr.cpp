// Reading Radiance pictures (.hdr). File format: Ward, "Real Pixels", Graphics Gems II, 1991, and the manual of Radiance, section
// "filefmts".

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include "engine/core/error.h"
#include "engine/core/input_file.h"
#include "engine/core/printable.h"
#include "engine/image/image.h"

namespace freevoxels {

namespace {

using Rgbe = std::array<std::uint8_t, 4>;  ///< mantissas and a common exponent

class HdrReader {
 public:
  HdrReader(const std::filesystem::path& file, std::int64_t maximumPixels) : file_(file), stream_(file, std::ios::binary) {
    readHeader();
    const std::int64_t pixels = std::int64_t(size_.x) * size_.y;
    if (pixels > maximumPixels) refuse(fmt::format("{}x{} pixels are too many; choose a smaller image", size_.x, size_.y));
  }

  Image read() {
    Image image{.size = size_};
    std::vector<Rgbe> row(std::size_t(size_.x));
    for (int y = 0; y < size_.y; ++y) {  // memory grows with what the file holds
      readRow(row);
      for (const Rgbe& pixel : row) image.pixels.push_back(color(pixel));
    }
    if (isBottomUp_) flipRows(image);
    return image;
  }

 private:
  [[noreturn]] void refuse(const std::string& why) const { fail(ErrorKind::Input, "cannot read '{}': {}", file_.string(), why); }

  std::string line() {
    constexpr std::size_t kLongest = 4096;
    std::string text;
    for (int byte = stream_.get(); byte != '\n'; byte = stream_.get()) {
      if (byte == std::istream::traits_type::eof() || text.size() == kLongest) refuse("its header does not end; write it again");
      text.push_back(char(byte));
    }
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0) text.pop_back();
    return text;
  }

  void readHeader() {
    if (!line().starts_with("#?")) refuse("it does not begin as a Radiance picture does; choose one, or an .exr");
    constexpr std::string_view kFormat = "FORMAT=", kExposure = "EXPOSURE=";
    for (std::string text = line(); !text.empty(); text = line()) {
      if (text.starts_with(kFormat) && !text.ends_with("32-bit_rle_rgbe"))
        refuse(fmt::format("its pixels are of the format '{}'; write it as 32-bit_rle_rgbe", printable(text.substr(kFormat.size()))));
      if (!text.starts_with(kExposure)) continue;
      const double exposure = std::strtod(text.c_str() + kExposure.size(), nullptr);
      if (std::isfinite(exposure) && exposure > 0.0) exposure_ *= exposure;
    }
    const std::string resolution = line();
    char sign = 0;
    int rest = 0;
    if (std::sscanf(resolution.c_str(), "%cY %d +X %d%n", &sign, &size_.y, &size_.x, &rest) != 3 || (sign != '-' && sign != '+') ||
        size_.x < 1 || size_.y < 1)
      refuse(fmt::format("its rows are laid out as '{}', and '-Y HEIGHT +X WIDTH' is understood; write it so", printable(resolution)));
    isBottomUp_ = sign == '+';
  }

  std::uint8_t byte() {
    const int value = stream_.get();
    if (value == std::istream::traits_type::eof()) refuse("it ends early; copy or download it again");
    return std::uint8_t(value);
  }

  Rgbe pixel() { return {byte(), byte(), byte(), byte()}; }

  void readRow(std::vector<Rgbe>& row) {
    constexpr std::size_t kShortest = 8, kLongest = 0x7fff;  // rows of other lengths are never compressed by component
    const Rgbe first = pixel();
    const bool isByComponent = row.size() >= kShortest && row.size() <= kLongest && first[0] == 2 && first[1] == 2 && first[2] < 128;
    if (!isByComponent) return readPixels(row, first);
    if ((std::size_t(first[2]) << 8 | first[3]) != row.size())
      refuse("a row of it has another length than its header says; write it again");
    for (std::size_t component = 0; component < 4; ++component)
      for (std::size_t x = 0; x < row.size();) {
        constexpr std::uint8_t kRun = 128;
        const std::uint8_t code = byte();
        const bool isRun = code > kRun;
        const std::size_t count = isRun ? code - kRun : code;
        if (count == 0 || count > row.size() - x) refuse("a run of it is longer than its row; write it again");
        std::uint8_t value = 0;
        for (std::size_t i = 0; i < count; ++i, ++x) {
          if (!isRun || i == 0) value = byte();
          row[x][component] = value;
        }
      }
  }

  /// Pixel by pixel; 1, 1, 1, n repeats the last one n times, and n counts 256 times as much after another such pixel.
  void readPixels(std::vector<Rgbe>& row, Rgbe next) {
    int shift = 0;
    for (std::size_t x = 0;;) {
      if (next[0] == 1 && next[1] == 1 && next[2] == 1 && x > 0) {
        const std::size_t count = shift > 16 ? row.size() + 1 : std::size_t(next[3]) << shift;
        if (count > row.size() - x) refuse("a run of it is longer than its row; write it again");
        std::fill_n(row.begin() + std::ptrdiff_t(x), count, row[x - 1]);
        x += count;
        shift += 8;
      } else {
        row[x++] = next;
        shift = 0;
      }
      if (x == row.size()) return;
      next = pixel();
    }
  }

  glm::vec4 color(const Rgbe& pixel) const {
    if (pixel[3] == 0) return {0.0f, 0.0f, 0.0f, 1.0f};
    constexpr int kBias = 128 + 8;
    const double scale = std::ldexp(1.0 / exposure_, int(pixel[3]) - kBias);
    return {float((pixel[0] + 0.5) * scale), float((pixel[1] + 0.5) * scale), float((pixel[2] + 0.5) * scale), 1.0f};
  }

  static void flipRows(Image& image) {
    const auto width = std::ptrdiff_t(image.size.x);
    for (int y = 0; y < image.size.y / 2; ++y) {
      const auto row = image.pixels.begin() + y * width;
      std::swap_ranges(row, row + width, image.pixels.begin() + (image.size.y - 1 - y) * width);
    }
  }

  const std::filesystem::path file_;
  std::ifstream stream_;
  glm::ivec2 size_{0};
  double exposure_ = 1.0;  ///< by which the pixels have been multiplied
  bool isBottomUp_ = false;
};

}  // namespace

bool isHdr(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return stream.get() == '#' && stream.get() == '?';
}

Image readHdr(const std::filesystem::path& file, std::int64_t maximumPixels) {
  checkInputFile("image", file);
  return HdrReader(file, maximumPixels).read();
}

}  // namespace freevoxels
