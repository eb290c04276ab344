#include "apps/common/render_command.h"

#include <CLI/CLI.hpp>

namespace freevoxels {

namespace {

constexpr const char* kRenderExamples =
    "IN with a run of # (or %04d) in its file name is the sequence of the files that have a number there, which takes the place\n"
    "of the run of # of each OUT; more volumes may follow IN.\n"
    "Examples:\n"
    "  freevoxels render cloud.vdb cloud.exr cloud.png\n"
    "  freevoxels render smoke.vdb smoke.png --orbit 120,10 --size 1920x1080 --background 0.02,0.03,0.05\n"
    "  freevoxels render procedural:shells shells.png --resolution 200 --transfer-function shells.json\n"
    "  freevoxels render cloud.vdb paper.png --paper --density-scale 40 --albedo 0.9,0.8,0.7\n"
    "  freevoxels render 'smoke_####.vdb' 'smoke_####.png' --frames 1-240:2\n"
    "  freevoxels render run1/smoke_*.vdb --out-dir images --format exr,png\n"
    "  freevoxels render --scene apps/scenes/cloud.json cloud.png\n";

}  // namespace

void RenderCommand::add(CLI::App& app) {
  CLI::App* command = app.add_subcommand("render", "Draw a volume, or a sequence of volumes, into images");
  options_.add(*command);
  sequence_.add(*command, options_.fixedView);
  options_.addSkipExisting(*command);
  command->footer(kRenderExamples);
  command->callback([this] {
    options_.messages.apply();
    options_.run(sequence_.plan(options_.scene));
  });
}

}  // namespace freevoxels
