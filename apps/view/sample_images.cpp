#include "apps/view/sample_images.h"

#include <algorithm>
#include <array>

#include "apps/view/embedded_file.h"

FREEVOXELS_EMBED(freevoxels_sample_cube, FREEVOXELS_SAMPLES "/cube.png");
FREEVOXELS_EMBED(freevoxels_sample_cloud, FREEVOXELS_SAMPLES "/cloud.png");
FREEVOXELS_EMBED(freevoxels_sample_plume, FREEVOXELS_SAMPLES "/plume.png");
FREEVOXELS_EMBED(freevoxels_sample_fire, FREEVOXELS_SAMPLES "/fire.png");
FREEVOXELS_EMBED(freevoxels_sample_marschner_lobb, FREEVOXELS_SAMPLES "/marschner-lobb.png");
FREEVOXELS_EMBED(freevoxels_sample_shells, FREEVOXELS_SAMPLES "/shells.png");
FREEVOXELS_EMBED(freevoxels_sample_rods, FREEVOXELS_SAMPLES "/rods.png");
FREEVOXELS_EMBED(freevoxels_sample_head, FREEVOXELS_SAMPLES "/head.png");

namespace freevoxels {

namespace {

struct Sample {
  std::string_view name;
  const unsigned char *begin, *end;
};

constexpr std::array kSamples{
    Sample{"cube", freevoxels_sample_cube, freevoxels_sample_cube_end},
    Sample{"cloud", freevoxels_sample_cloud, freevoxels_sample_cloud_end},
    Sample{"plume", freevoxels_sample_plume, freevoxels_sample_plume_end},
    Sample{"fire", freevoxels_sample_fire, freevoxels_sample_fire_end},
    Sample{"marschner-lobb", freevoxels_sample_marschner_lobb, freevoxels_sample_marschner_lobb_end},
    Sample{"shells", freevoxels_sample_shells, freevoxels_sample_shells_end},
    Sample{"rods", freevoxels_sample_rods, freevoxels_sample_rods_end},
    Sample{"head", freevoxels_sample_head, freevoxels_sample_head_end},
};

}  // namespace

std::span<const unsigned char> sampleImage(std::string_view name) {
  const auto found = std::ranges::find(kSamples, name, &Sample::name);
  if (found == kSamples.end()) return {};
  return {found->begin, found->end};
}

}  // namespace freevoxels
