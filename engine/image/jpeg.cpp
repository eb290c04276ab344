// 8-bit sRGB JPEG out, by libjpeg-turbo. The bytes written depend on the image only.

#include <cstddef>
#include <cstdio>  // before jpeglib.h, which needs both

#include <jpeglib.h>

#include <array>
#include <csetjmp>
#include <cstdlib>
#include <stdexcept>

#include "engine/core/atomic_file.h"
#include "engine/core/checked_file.h"
#include "engine/core/error.h"
#include "engine/image/display.h"

namespace freevoxels {

namespace {

/// libjpeg's quality, 1 to 100: at 95 artefacts are not seen beside the original, and colour is not stored more coarsely than brightness.
constexpr int kQuality = 95;

/// Compresses into memory, which it owns. Its members hold nothing that libjpeg's long jump would fail to destroy.
class JpegEncoder {
 public:
  JpegEncoder() {
    state_.err = jpeg_std_error(&error_.base);
    error_.base.error_exit = [](j_common_ptr state) {
      auto* const error = reinterpret_cast<Error*>(state->err);
      error->base.format_message(state, error->message.data());
      std::longjmp(error->jump, 1);
    };
    error_.base.output_message = [](j_common_ptr) {};  // warnings
  }
  ~JpegEncoder() {
    jpeg_destroy_compress(&state_);
    std::free(bytes_);
  }
  JpegEncoder(const JpegEncoder&) = delete;
  JpegEncoder& operator=(const JpegEncoder&) = delete;

  /// False after an error, which `message` then tells.
  bool encode(glm::ivec2 size, const std::uint8_t* samples) {
    if (setjmp(error_.jump)) return false;
    jpeg_create_compress(&state_);
    jpeg_mem_dest(&state_, &bytes_, &size_);
    state_.image_width = JDIMENSION(size.x);
    state_.image_height = JDIMENSION(size.y);
    state_.input_components = 3;
    state_.in_color_space = JCS_RGB;
    jpeg_set_defaults(&state_);
    jpeg_set_quality(&state_, kQuality, TRUE);
    for (int c = 0; c < state_.num_components; ++c) state_.comp_info[c].h_samp_factor = state_.comp_info[c].v_samp_factor = 1;
    state_.optimize_coding = TRUE;
    jpeg_start_compress(&state_, TRUE);
    while (state_.next_scanline < state_.image_height) {
      auto* row = const_cast<JSAMPLE*>(samples) + std::size_t(state_.next_scanline) * 3 * std::size_t(size.x);
      jpeg_write_scanlines(&state_, &row, 1);
    }
    jpeg_finish_compress(&state_);
    return true;
  }

  const char* message() const { return error_.message.data(); }
  const std::uint8_t* bytes() const { return bytes_; }
  std::size_t size() const { return size_; }

 private:
  struct Error {
    jpeg_error_mgr base;  // first, as libjpeg knows this one only
    std::jmp_buf jump;
    std::array<char, JMSG_LENGTH_MAX> message;
  };

  jpeg_compress_struct state_{};
  Error error_{};
  unsigned char* bytes_ = nullptr;
  unsigned long size_ = 0;
};

}  // namespace

void writeJpeg(const std::filesystem::path& file, const Image& image, const DisplayLook& look) {
  FV_CHECK_LT(0, image.size.x);
  FV_CHECK_LT(0, image.size.y);
  FV_CHECK_EQ(image.pixels.size(), std::size_t(image.size.x) * std::size_t(image.size.y));
  DisplayLook opaque = look;
  if (!opaque.background) opaque.background = Background{};
  const std::vector<std::uint8_t> samples = displaySamples<std::uint8_t>(image, opaque);
  writeAtomically(file, [&](const std::filesystem::path& path) {
    JpegEncoder encoder;
    if (!encoder.encode(image.size, samples.data())) throw std::runtime_error(encoder.message());
    CheckedFile output(path);
    output.write(encoder.bytes(), encoder.size());
    output.close();
  });
}

}  // namespace freevoxels
