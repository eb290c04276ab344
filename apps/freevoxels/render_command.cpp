#include "apps/freevoxels/render_command.h"

#include <CLI/CLI.hpp>

namespace freevoxels {

namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  freevoxels render cloud.vdb cloud.exr cloud.png\n"
    "  freevoxels render smoke.vdb smoke.png --orbit 120,10 --size 1920x1080 --background 0.02,0.03,0.05\n"
    "  freevoxels render procedural:shells shells.png --resolution 200 --transfer-function shells.json\n"
    "  freevoxels render cloud.vdb paper.png --paper --density-scale 40 --albedo 0.9,0.8,0.7\n"
    "  freevoxels render --scene apps/scenes/cloud.json cloud.png\n";

}  // namespace

void RenderCommand::add(CLI::App& app) {
  CLI::App* command = app.add_subcommand("render", "Draw a volume into pictures");
  options_.add(*command);
  command->footer(kExamples);
  command->callback([this] {
    options_.scene.takeScene();
    options_.run({options_.scene.output.files});
  });
}

}  // namespace freevoxels
