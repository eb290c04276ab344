#include "apps/freevoxels/commands.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <span>

#include "apps/common/merge.h"
#include "engine/core/error.h"

namespace freevoxels {

namespace {

constexpr const char* kMergeExamples =
    "PARTs are written by 'freevoxels render --share I/N --sums'; the first name that is no such file, and all behind it, are images "
    "to\nwrite. Parts of different N can be mixed, as long as they have each share once.\n"
    "Examples:\n"
    "  freevoxels render cloud.vdb part_0.exr --share 0/2 --sums\n"
    "  freevoxels render cloud.vdb part_1.exr --share 1/2 --sums\n"
    "  freevoxels merge part_0.exr part_1.exr cloud.png cloud.exr\n";

}  // namespace

void MergeCommand::add(CLI::App& app) {
  CLI::App* command = app.add_subcommand("merge", "Add up the parts of an image that were rendered share by share");
  command->add_option("FILES", files_, "PART... OUT...: files of sums, then images to write, .exr (linear, premultiplied) or .png (sRGB)")
      ->required();
  scene_.addSection(*command, "output");
  messages_.add(*command);
  command->footer(kMergeExamples);
  command->callback([this] { run(); });
}

void MergeCommand::run() const {
  messages_.apply();
  checkDistinct(files_);
  const auto firstOutput = std::ranges::find_if_not(files_, isPartOfImage);
  if (firstOutput == files_.begin())
    fail(ErrorKind::Usage, "'{}' is no file of sums: name the files that 'freevoxels render --share I/N --sums' wrote, then images",
         files_.front());
  if (firstOutput == files_.end()) fail(ErrorKind::Usage, "OUT is required: name an image to write behind the parts, .exr or .png");
  const OutputDescription& output = scene_.description.output;
  const std::span<const std::string> images = std::span(files_).subspan(std::size_t(firstOutput - files_.begin()));
  for (const std::string& file : images)
    if (isPartOfImage(file)) fail(ErrorKind::Usage, "'{}' holds sums and would be replaced: name all parts before the images", file);
  checkOutputs(output, images);

  mergeParts(std::span(files_).first(std::size_t(firstOutput - files_.begin())), output, images);
  if (messages_.quiet) return;
  printNames(images);
}

}  // namespace freevoxels
