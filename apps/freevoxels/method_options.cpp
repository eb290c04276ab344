#include "apps/freevoxels/method_options.h"

#include <CLI/CLI.hpp>
#include <cstdint>

#include "engine/core/error.h"

namespace freevoxels {

std::string tableText(const TableSettings& table) {
  return fmt::format("{} {} {} {}", int(table.directions), int(table.code), int(table.filter), table.pathLengthCorrection);
}

void MethodOptions::add(CLI::App& app) {
  const char* const group = "Method";
  addWord(app, "--composite", kCompositeWords, composite,
          "How splats become pixels: colours mixed by the table with exact opacity, the paper's plain sum, or back-to-front alpha "
          "blending for comparison [normalised]")
      ->group(group);
  addWord(app, "--draw", kDrawWords, draw,
          "How the volume becomes the image: gather marches rays through it, splats draws a billboard for every voxel; auto: gather "
          "if --attenuation is auto or exact and --composite is not sorted, else splats [auto]")
      ->group(group);
  addWord(app, "--attenuation", kAttenuationWords, attenuation,
          "Transmittance of splats to the eye: interpolated between four directions of the table, its nearest direction, or exact, "
          "along rays from the eye that are swept for every frame; auto: exact for volumes with emission and if the eye is inside "
          "the volume, bilinear if it is far away, a mix in between [auto]")
      ->group(group);
  addWord(app, "--directions", kDirectionWords, directions,
          "Directions of the table; 98 are more exact and take more memory and time [26]")
      ->group(group);
  addWord(app, "--code", kCodeWords, code, "What a byte of the table holds: optical depth or transmittance [depth8]")->group(group);
  app.add_flag_function(
         "--path-length-correction,!--no-path-length-correction",
         [this](std::int64_t count) { pathLengthCorrection = count > 0; },
         "Whether diagonal steps of the table count with their full length [yes]")
      ->group(group);
  app.add_flag_function(
         "--gradient,!--no-gradient", [this](std::int64_t count) { gradient = count > 0; },
         "Whether the transmittance varies across a splat [yes]")
      ->group(group);
  addNumber(
      app, "--lod", "PIXELS", lod,
      "Size on the image up to which blocks of voxels are drawn as one element; 0 always draws voxels, as does --composite "
      "sorted [1]",
      {0.0, 1e6})
      ->group(group);
  app.add_flag_function(
         "--culling,!--no-culling", [this](std::int64_t count) { culling = count > 0; },
         "Whether blocks outside of the image or hidden by others are left out; --composite sorted draws all [yes]")
      ->group(group);
  addNumber(app, "--cull-threshold", "TRANSMITTANCE", cullThreshold,
            "Transmittance to the eye below which a block is hidden, and a ray of the gather ends; 0 hides nothing [1/512]",
            {.minimum = 0.0, .maximum = 1.0})
      ->group(group);
  addWord(app, "--hierarchy-filter", kHierarchyFilterWords, hierarchyFilter,
          "Mean of its voxels' transmittances that a block has [geometric]")
      ->group(group);
  app.add_flag("--paper", paper,
               "The paper's method, for comparison: --composite additive --attenuation nearest --directions 26 --code linear8 "
               "--no-path-length-correction --no-gradient --lod 0 --no-culling. Any of these that is given wins. 1 to 25 dB worse than "
               "the default")
      ->group(group);
}

TableSettings MethodOptions::table() const {
  return {
      .code = AttenuationCode(code.value_or(int(paper ? AttenuationCode::Linear8 : AttenuationCode::Depth8))),
      .pathLengthCorrection = pathLengthCorrection.value_or(!paper),
      .directions = DirectionSet(directions.value_or(0) + 1),
      .filter = HierarchyFilter(hierarchyFilter.value_or(int(HierarchyFilter::Geometric)))};
}

void MethodOptions::apply(FrameSettings& frame) const {
  frame.draw = Draw(draw.value_or(int(Draw::Auto)));
  frame.composite = Composite(composite.value_or(int(paper ? Composite::Additive : Composite::Normalised)));
  frame.attenuation = AttenuationLookup(
      attenuation.value_or(int(paper ? AttenuationLookup::Nearest : AttenuationLookup::Auto)));
  if (frame.draw == Draw::Gather && !canGather(frame))
    fail(ErrorKind::Usage,
         "--draw gather computes exact transmittance and no sorted image: leave --attenuation and --composite out, or "
         "use --draw splats");
  frame.gradient = gradient.value_or(!paper);
  frame.lod = float(lod.value_or(paper ? 0.0 : 1.0));
  frame.culling = culling.value_or(!paper);
  frame.cullThreshold = float(cullThreshold.value_or(double(frame.cullThreshold)));
}

void MethodOptions::describe(OptionList& options) const {
  FrameSettings frame;
  apply(frame);
  options.emplace_back("--composite", kCompositeWords[std::size_t(frame.composite)]);
  options.emplace_back("--draw", kDrawWords[std::size_t(frame.draw)]);
  options.emplace_back("--attenuation", kAttenuationWords[std::size_t(frame.attenuation)]);
  options.emplace_back("--directions", kDirectionWords[std::size_t(table().directions) - 1]);
  options.emplace_back("--code", kCodeWords[std::size_t(table().code)]);
  options.emplace_back(
      table().pathLengthCorrection ? "--path-length-correction" : "--no-path-length-correction", "");
  options.emplace_back(frame.gradient ? "--gradient" : "--no-gradient", "");
  options.emplace_back("--lod", numberText(lod.value_or(double(frame.lod))));
  options.emplace_back(frame.culling ? "--culling" : "--no-culling", "");
  options.emplace_back("--cull-threshold", numberText(double(frame.cullThreshold)));
  options.emplace_back("--hierarchy-filter", kHierarchyFilterWords[std::size_t(table().filter)]);
}

}  // namespace freevoxels
