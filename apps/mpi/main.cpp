// freevoxels-mpi render | turntable | bake: the commands of freevoxels, done by all processes of an MPI job together.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <thread>

#include "apps/common/bake_command.h"
#include "apps/common/program.h"
#include "apps/common/render_command.h"
#include "apps/common/turntable_command.h"
#include "apps/mpi/mpi_job.h"

namespace {

/// How long a rank waits for rank 0 to report the same error and to end the job.
constexpr std::chrono::seconds kPatience{2};

}  // namespace

int main(int argc, char** argv) {
  freevoxels::MpiJob job(argc, argv);
  if (!job.leads() && std::freopen("/dev/null", "w", stdout) == nullptr) job.abort(1);

  CLI::App app("Draws volumes as freevoxels does, by all processes of an MPI job together.", "freevoxels-mpi");
  freevoxels::RenderCommand render(&job);
  freevoxels::TurntableCommand turntable(&job);
  freevoxels::BakeCommand bake(&job);
  render.add(app);
  turntable.add(app);
  bake.add(app);
  app.require_subcommand(1);
  app.footer(
      "Examples:\n"
      "  mpirun -n 4 freevoxels-mpi render cloud.vdb cloud.exr\n"
      "  srun --mpi=pmix freevoxels-mpi turntable cloud.vdb orbit_####.png --ranks-per-frame 2\n"
      "  mpirun -n 4 freevoxels-mpi bake cloud.vdb cloud.fvx --compress\n"
      "Every rank reads the volume; rank 0 prints and writes. Images and files have the same bits for any number of ranks.");

  const int exitCode = freevoxels::runProgram(app, argc, argv, [&] {
    if (job.leads()) return;
    std::this_thread::sleep_for(kPatience);
    freevoxels::beginMessagesWith("freevoxels-mpi: on " + job.name());
  });
  if (exitCode != 0) job.abort(exitCode);
  return 0;
}
