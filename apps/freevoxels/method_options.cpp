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
          "How the splats become the picture; sorted is back-to-front alpha blending, to compare with "
          "[normalised]")
      ->group(group);
  addWord(app, "--draw", kDrawWords, draw,
          "How the volume becomes the image; gather marches through it for every sample of the image, splats draws a "
          "billboard for every voxel; auto: gather where attenuation is auto or exact and the composite is not "
          "sorted, else splats [auto]")
      ->group(group);
  addWord(app, "--attenuation", kAttenuationWords, attenuation,
          "How the table is looked up between its directions; exact does not read it, but "
          "sweeps from the eye for every frame; auto: exact of what shines and where the eye is inside, bilinear "
          "where it "
          "is far away, and a mix of both between [auto]")
      ->group(group);
  addWord(app, "--directions", kDirectionWords, directions,
          "How many directions the table holds; 98 are more exact and take more memory and time [26]")
      ->group(group);
  addWord(app, "--code", kCodeWords, code, "What a byte of the table holds [depth8]")->group(group);
  app.add_flag_function(
         "--path-length-correction,!--no-path-length-correction",
         [this](std::int64_t count) { pathLengthCorrection = count > 0; },
         "Whether a diagonal step counts its length in full [yes]")
      ->group(group);
  app.add_flag_function(
         "--gradient,!--no-gradient", [this](std::int64_t count) { gradient = count > 0; },
         "Whether transmittance varies across a splat [yes]")
      ->group(group);
  addNumber(
      app, "--lod", "PIXELS", lod,
      "Size on the image up to which blocks of voxels are drawn as one splat; 0: always voxels, as sorted "
      "is whatever this is [1]",
      {0.0, 1e6})
      ->group(group);
  app.add_flag_function(
         "--culling,!--no-culling", [this](std::int64_t count) { culling = count > 0; },
         "Whether blocks outside of the image or behind others are left out; sorted draws all [yes]")
      ->group(group);
  addNumber(app, "--cull-threshold", "TRANSMITTANCE", cullThreshold,
            "Transmittance to the eye below which a block is behind others; 0: none is [1/512]",
            {.minimum = 0.0, .maximum = 1.0})
      ->group(group);
  addWord(app, "--hierarchy-filter", kHierarchyFilterWords, hierarchyFilter,
          "Which mean of its voxels' transmittances a block has [geometric]")
      ->group(group);
  app.add_flag("--paper", paper,
               "As the paper: additive, nearest, 26 directions, linear8, no path-length correction, no "
               "gradient, lod 0, no culling; any of the eight that is given wins. To compare with: 1 to 25 dB worse than the default, and "
               "opaque parts burn out")
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
    fail(ExitCode::Usage,
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
