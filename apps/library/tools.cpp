// Files of images, scenes and baked volumes, and what programs say of volumes and devices.

#include "apps/common/program.h"
#include "apps/common/scene_tools.h"
#include "apps/library/translation.h"
#include "engine/volume/transfer_source.h"

namespace freevoxels::v1 {

void save(const std::filesystem::path& file, const Image& image, std::string_view scene) {
  translated([&] {
    const std::size_t pixels = std::size_t(std::max(image.width, 0)) * std::size_t(std::max(image.height, 0));
    if (pixels == 0 || image.pixels.size() != 4 * pixels || (!image.depth.empty() && image.depth.size() != pixels))
      fail(freevoxels::ErrorKind::Input,
           "an image of {} x {} pixels has {} values and {} depths: it needs 4 values, and 1 depth or none, a pixel", image.width,
           image.height, image.pixels.size(), image.depth.size());
    freevoxels::Image copy{.size = {image.width, image.height}, .pixels = std::vector<glm::vec4>(pixels), .depth = image.depth};
    for (std::size_t i = 0; i < pixels; ++i)
      copy.pixels[i] = {image.pixels[4 * i], image.pixels[4 * i + 1], image.pixels[4 * i + 2], image.pixels[4 * i + 3]};
    saveImage(file.string(), copy, parseScene(scene));
  });
}

std::vector<std::string> sceneWarnings(const std::filesystem::path& file) {
  return translated([&] { return freevoxels::sceneWarnings(file); });
}

std::string loadScene(const std::filesystem::path& file) {
  return translated([&] { return freevoxels::loadScene(file).dump(2, ' ', false, Json::error_handler_t::replace); });
}

void saveScene(const std::filesystem::path& file, std::string_view scene) {
  translated([&] { freevoxels::saveScene(file, parseScene(scene)); });
}

void bake(const std::filesystem::path& volume, const std::filesystem::path& file, std::string_view scene, const Progress& progress) {
  translated([&] { bakeFile(volume.string(), file.string(), parseScene(scene), {}, progress); });
}

void bake(const Volume& volume, const std::filesystem::path& file, std::string_view scene, const Progress& progress) {
  translated([&] { bakeShared(*volume.state_->volume, file.string(), parseScene(scene), progress); });
}

void convert(const std::filesystem::path& volume, const std::filesystem::path& file, std::string_view scene, const Progress& progress) {
  translated([&] { convertFile(volume.string(), file.string(), parseScene(scene), {}, progress); });
}

std::string info(const std::filesystem::path& volume, std::string_view scene) {
  return translated([&] { return infoOf(volume.string(), parseScene(scene)).dump(2, ' ', false, Json::error_handler_t::replace); });
}

std::string devices() {
  return translated([&] { return toJson(findDevices()).dump(2, ' ', false, Json::error_handler_t::replace); });
}

std::string presets() {
  return translated([] { return presetsJson(); });
}

void merge(const std::vector<std::string>& parts, const std::vector<std::string>& images, std::string_view scene) {
  translated([&] { mergeFiles(parts, images, parseScene(scene)); });
}

std::string version() {
  return programVersion();
}

}  // namespace freevoxels::v1
