// A volume in, images of it from three sides out: apps/manual/library.md.

#include <cstdio>
#include <freevoxels/freevoxels.h>
#include <string>

namespace fv = freevoxels::v1;

int main(int count, char** arguments) {
  try {
    const fv::Volume volume = fv::Volume::open(count > 1 ? arguments[1] : "procedural:cloud");
    fv::Renderer renderer(volume, R"({"size": [640, 480], "camera": {"fov": 30}, "orbit": [120, 20]})");
    for (int azimuth = 0; azimuth < 360; azimuth += 120) {
      const fv::Image image = renderer.render("{\"orbit\": [" + std::to_string(azimuth) + ", 20]}");
      const std::string file = "view_" + std::to_string(azimuth) + ".png";
      fv::save(file, image);
      std::printf("%s of %s, on %s\n", file.c_str(), volume.source().c_str(), renderer.device().c_str());
    }
  } catch (const fv::Error& error) {
    std::fprintf(stderr, "minimal: %s\n", error.what());
    return int(error.kind());
  }
}
